// Geometry of environments and objects as markers, and the load report. Latched; sent again when they change.
#pragma once

#include <ros/node_handle.h>

#include "sending/drawing_thread.h"
#include "sending/step_publisher.h"

namespace blem_sim::node {

/** `~environment_markers` in the world and `~object_markers` in each object's own frame, which /tf moves. */
class GeometryMarkerPublisher : public StepPublisher {
 public:
  GeometryMarkerPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator);
  void publish(const sim::StepReport&) override {}
  void modelsChanged() override;
  /** Draws beside the steps, if anybody looks. */
  void cloudsChanged() override;

 private:
  const sim::Simulator& simulator_;
  ros::Publisher environments_, objects_;
  DrawingThread thread_;  // last: it publishes
};

/** `~load_report`. */
class LoadReportPublisher : public StepPublisher {
 public:
  LoadReportPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator);
  void publish(const sim::StepReport&) override {}
  void modelsChanged() override;
  void cloudsChanged() override { modelsChanged(); }

 private:
  const sim::Simulator& simulator_;
  ros::Publisher publisher_;
};

}  // namespace blem_sim::node
