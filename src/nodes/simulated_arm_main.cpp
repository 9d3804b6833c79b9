#include "src/nodes/simulated_arm_node.h"
#include "src/ros/node_main.h"

int main(int argc, char** argv) {
  return demo_logger::runNode(argc, argv, "simulated_arm", [] {
    const ros::NodeHandle private_node("~");
    demo_logger::SimulatedArmNode arm(ros::NodeHandle(), private_node,
                                      demo_logger::readSimulatedArmParameters(private_node));
    arm.run();
  });
}
