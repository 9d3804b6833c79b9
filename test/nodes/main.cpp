#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test", ros::init_options::AnonymousName);
  const ros::NodeHandle node;  // keeps ROS up between the tests
  return RUN_ALL_TESTS();
}
