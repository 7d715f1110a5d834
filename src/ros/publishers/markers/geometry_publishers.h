// Geometry of environments and objects as markers, and the load report. Latched; sent again when they change.
#pragma once

#include <ros/node_handle.h>

#include <set>
#include <string>

#include "sending/drawing_thread.h"
#include "sending/step_publisher.h"

namespace blem_sim::node {

/** `~environment_markers` in the world, `~object_markers` in each object's own frame, which /tf moves, and on request `~layer_markers` in
 * the frames of links and objects. */
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
  ros::Publisher layers_;       // none unless the configuration asks for them
  std::set<std::string> told_;  // environments that are sent in pieces
  DrawingThread thread_;        // last: it publishes
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
