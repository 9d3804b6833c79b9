// keyboard_node: wires the keys of its terminal to joy, as if they were a joystick.
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>

#include <cstdio>

#include "src/nodes/keyboard_device.h"
#include "src/nodes/terminal.h"
#include "src/ros/node_main.h"
#include "src/ros/parameters.h"

namespace demo_logger {
namespace {

struct KeyboardParameters {
  KeyboardDevice::Configuration keyboard;
  double rate = 50.0;  // [Hz]
};

KeyboardParameters readKeyboardParameters(const ros::NodeHandle& private_node) {
  Parameters parameters = readParameters(private_node);
  KeyboardParameters result;
  result.rate = parameters.number("joy_rate", result.rate, {5.0, 500.0, "Hz"});
  result.keyboard.hold_time = parameters.number("hold_time", result.keyboard.hold_time, {0.05, 5.0, "s"});
  result.keyboard.press_time = parameters.number("press_time", result.keyboard.press_time, {0.05, 5.0, "s"});
  parameters.rejectUnknown();
  return result;
}

void readKeysUntilShutdown() {
  const KeyboardParameters parameters = readKeyboardParameters(ros::NodeHandle("~"));
  Terminal terminal;
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<sensor_msgs::Joy>("joy", 100);
  KeyboardDevice keyboard(parameters.keyboard);
  std::printf("%s", KeyboardDevice::help().c_str());
  std::fflush(stdout);
  // By the wall clock: hands do not follow a simulation's.
  for (ros::WallRate rate(parameters.rate); ros::ok(); rate.sleep()) {
    const auto now = static_cast<Nanoseconds>(ros::WallTime::now().toNSec());
    for (const char key : terminal.read()) keyboard.press(key, now);
    const DeviceReading reading = keyboard.read(now);
    sensor_msgs::Joy joy;
    joy.header.stamp = ros::Time::now();
    joy.axes.assign(reading.axes.begin(), reading.axes.end());
    joy.buttons.assign(reading.buttons.begin(), reading.buttons.end());
    publisher.publish(joy);
    ros::spinOnce();
  }
}

}  // namespace
}  // namespace demo_logger

int main(int argc, char** argv) {
  return demo_logger::runNode(argc, argv, "keyboard", demo_logger::readKeysUntilShutdown);
}
