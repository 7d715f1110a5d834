// Fields of the arguments of a Simulator's calls.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "blem_sim/sim/simulator_types.h"
#include "blem_sim/sim/trajectory.h"

namespace blem_sim::sim {

template <typename Visitor>
void visitFields(Visitor& visit, TrajectoryPoint& point) {
  visit(point.time_from_start, point.positions, point.velocities, point.accelerations, point.effort);
}

template <typename Visitor>
void visitFields(Visitor& visit, JointTrajectory& trajectory) {
  visit(trajectory.joints, trajectory.start_time, trajectory.points);
}

template <typename Visitor>
void visitFields(Visitor& visit, JointCommandMessage& command) {
  visit(command.joints, command.positions, command.velocities, command.efforts);
}

template <typename Visitor>
void visitFields(Visitor& visit, JointVelocityCommand& command) {
  visit(command.joints, command.velocities, command.acceleration, command.max_effort);
}

template <typename Visitor>
void visitFields(Visitor& visit, BaseVelocityCommand& command) {
  visit(command.x, command.y, command.turn, command.max_force, command.max_torque);
}

template <typename Visitor>
void visitFields(Visitor& visit, dynamics::BodyState& state) {
  visit(state.X_WB, state.v_WCom, state.w_WB);
}

template <typename Visitor>
void visitFields(Visitor& visit, BodyLoad& load) {
  visit(load.wrench.force, load.wrench.torque, load.p_B);
}

template <typename Visitor>
void visitFields(Visitor& visit, LoadTime& when) {
  visit(when.start, when.duration);
}

template <typename Visitor>
void visitFields(Visitor& visit, geometry::MassProperties& inertial) {
  visit(inertial.mass, inertial.com, inertial.inertia);
}

template <typename Visitor>
void visitFields(Visitor& visit, BoundaryWidth& width) {
  visit(width.metres, width.automatic);
}

template <typename Visitor>
void visitFields(Visitor& visit, ContactOverrides& contact) {
  visit(contact.boundary_width, contact.friction, contact.restitution, contact.impact_friction_factor, contact.impact_friction_speed,
        contact.stiffness, contact.damping, contact.shrink);
}

template <typename Visitor>
void visitFields(Visitor& visit, model::CloudFilter& filter) {
  visit.choice(&filter.kind, 5);
  visit(filter.size, filter.neighbours, filter.factor, filter.axis, filter.lower, filter.upper, filter.order);
}

template <typename Visitor>
void visitFields(Visitor& visit, model::CloudOptions& cloud) {
  visit.choice(&cloud.as, 3);
  visit.choice(&cloud.mesher, 5);
  visit(cloud.point_radius, cloud.auto_radius, cloud.max_edge, cloud.max_depth_jump, cloud.cell, cloud.fill_holes, cloud.viewpoint,
        cloud.filters);
}

template <typename Visitor>
void visitFields(Visitor& visit, model::VoxelMapOptions& map) {
  visit(map.voxel, map.min_hits, map.memory, map.expire_after, map.max_voxels);
}

template <typename Visitor>
void visitFields(Visitor& visit, LiveConfig& live) {
  visit.choice(&live.type, 3);
  visit.choice(&live.update, 2);
  visit(live.topic, live.frame, live.map, live.fade_speed, live.occupied, live.wall_height);
}

/** Its vertices, and its triangles if it has some, of which geometry is made again. */
template <typename Visitor>
void visitFields(Visitor& visit, CloudSurface& surface) {
  geometry::TriangleMesh mesh;
  if (surface.geometry) mesh.vertices = surface.geometry->mesh().vertices;
  if (surface.geometry && surface.isMesh()) mesh.elements = surface.geometry->mesh().elements;
  visit(surface.radius, surface.origin, mesh.vertices, mesh.elements);
  if (surface.geometry || mesh.vertices.empty()) return;
  mesh = surface.isMesh() ? geometry::cleanMesh(std::move(mesh), &surface.report, geometry::RepeatedIndices::ARE_DEGENERATE)
                          : geometry::pointCloudMesh(mesh.vertices, &surface.report);
  surface.geometry = std::make_shared<const contact::CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(std::move(mesh)));
}

template <typename Visitor>
void visitFields(Visitor& visit, EnvironmentConfig& environment) {
  visit(environment.name, environment.uri, environment.plane, environment.live, environment.X_WE, environment.scale, environment.cloud,
        environment.contact);
}

template <typename Visitor>
void visitFields(Visitor& visit, JointGains& gains) {
  visit(gains.p, gains.i, gains.d, gains.i_clamp);
}

/** Fields of a spawned robot: all that a call of spawn_urdf_model sets. */
template <typename Visitor>
void visitFields(Visitor& visit, RobotConfig& robot) {
  visit(robot.name, robot.name_space, robot.urdf, robot.urdf_xml, robot.fixed_base, robot.X_WR, robot.pid_gains);
  visit.choice(&robot.motors, 3);
}

}  // namespace blem_sim::sim
