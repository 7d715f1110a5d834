#include "saving/record_services.h"

#include <blem_sim/StartRecord.h>
#include <blem_sim/StopRecord.h>

namespace blem_sim::node {

RecordServices::RecordServices(const ros::NodeHandle& private_node, InputRecorder* recorder, const ServiceFiles& files)
    : services_(private_node) {
  services_.add<StartRecord>("start_record", [recorder, files](const auto& request, auto* response) {
    const std::string file = files.allowed(request.file);
    recorder->start(file);
    response->status_message = "records into " + file;
  });
  services_.add<StopRecord>("stop_record", [recorder](const auto&, auto* response) { response->status_message = recorder->stop(); });
}

}  // namespace blem_sim::node
