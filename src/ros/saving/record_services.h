#pragma once

#include "saving/input_recorder.h"
#include "saving/service_files.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~start_record`, `~stop_record`. */
class RecordServices {
 public:
  /** @param files that records may be */
  RecordServices(const ros::NodeHandle& private_node, InputRecorder* recorder, const ServiceFiles& files);

 private:
  ServiceGroup services_;
};

}  // namespace blem_sim::node
