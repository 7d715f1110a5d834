// Sums of the layouts that control_msgs and controller_manager_msgs have in ROS Noetic: clients built against them connect.
#include <blem_sim/FollowJointTrajectoryAction.h>
#include <blem_sim/GripperCommandAction.h>
#include <blem_sim/JointTrajectoryControllerState.h>
#include <blem_sim/ListControllerTypes.h>
#include <blem_sim/ListControllers.h>
#include <blem_sim/LoadController.h>
#include <blem_sim/QueryTrajectoryState.h>
#include <blem_sim/SwitchController.h>
#include <blem_sim/UnloadController.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/service_traits.h>

#include <string>

namespace blem_sim::node {
namespace {

template <typename Message>
std::string sum() {
  return ros::message_traits::md5sum<Message>();
}

template <typename Service>
std::string serviceSum() {
  return ros::service_traits::md5sum<Service>();
}

TEST(ControlMessages, ActionsHaveTheLayoutsOfControlMsgs) {
  EXPECT_EQ(sum<FollowJointTrajectoryAction>(), "bc4f9b743838566551c0390c65f1a248");
  EXPECT_EQ(sum<FollowJointTrajectoryActionGoal>(), "cff5c1d533bf2f82dd0138d57f4304bb");
  EXPECT_EQ(sum<FollowJointTrajectoryActionResult>(), "c4fb3b000dc9da4fd99699380efcc5d9");
  EXPECT_EQ(sum<FollowJointTrajectoryActionFeedback>(), "d8920dc4eae9fc107e00999cce4be641");
  EXPECT_EQ(sum<GripperCommandAction>(), "950b2a6ebe831f5d4f4ceaba3d8be01e");
}

TEST(ControlMessages, StateAndQueryHaveTheLayoutsOfControlMsgs) {
  EXPECT_EQ(sum<JointTrajectoryControllerState>(), "10817c60c2486ef6b33e97dcd87f4474");
  EXPECT_EQ(serviceSum<QueryTrajectoryState>(), "ec93cdecbd8062d761aa52b7c90cd44b");
}

TEST(ControlMessages, ServicesHaveTheLayoutsOfControllerManagerMsgs) {
  EXPECT_EQ(serviceSum<ListControllers>(), "1341feb2e63fa791f855565d0da950d8");
  EXPECT_EQ(serviceSum<ListControllerTypes>(), "c1d4cd11aefa9f97ba4aeb5b33987f4e");
  EXPECT_EQ(serviceSum<LoadController>(), "647e5c54b8d6468952d8d31f1efe96c0");
  EXPECT_EQ(serviceSum<UnloadController>(), "647e5c54b8d6468952d8d31f1efe96c0");
  EXPECT_EQ(sum<SwitchController::Request>(), "36d99a977432b71d4bf16ce5847949d7");
  EXPECT_EQ(serviceSum<SwitchController>(), "b29a7abc673b2c54c14b54e50f8d06a5");
}

}  // namespace
}  // namespace blem_sim::node
