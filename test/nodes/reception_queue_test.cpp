#include "src/nodes/reception_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace demo_logger {
namespace {

Received makeReceived(std::size_t source, Nanoseconds steady) {
  const Received::JointStates event(boost::make_shared<sensor_msgs::JointState>(), boost::make_shared<ros::M_string>(),
                                    ros::Time(1, 0));
  return {source, event, steady};
}

TEST(ReceptionQueueTest, MessagesComeOutOnceInTheOrderInWhichTheyCame) {
  ReceptionQueue queue(2);
  for (int i = 0; i < 5; ++i) queue.push(makeReceived(i % 2, i));
  std::vector<Received> taken;
  queue.take(taken);
  ASSERT_EQ(taken.size(), 5U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(taken[static_cast<std::size_t>(i)].steady, i);
  queue.take(taken);
  EXPECT_TRUE(taken.empty());
}

TEST(ReceptionQueueTest, WhatDoesNotFitIsCountedForItsSource) {
  ReceptionQueue queue(2, /*capacity=*/3);
  for (int i = 0; i < 3; ++i) queue.push(makeReceived(0, i));
  queue.push(makeReceived(1, 3));
  queue.push(makeReceived(1, 4));
  queue.push(makeReceived(0, 5));
  EXPECT_EQ(queue.lost(), (std::vector<std::uint64_t>{1, 2}));
  std::vector<Received> taken;
  queue.take(taken);
  EXPECT_EQ(taken.size(), 3U);
  queue.push(makeReceived(1, 6));
  queue.take(taken);
  EXPECT_EQ(taken.size(), 1U) << "there is room again";
}

TEST(ReceptionQueueTest, HoldsTwoSecondsAtEightKilohertz) { EXPECT_GE(ReceptionQueue::kCapacity, 2U * 8000U); }

TEST(ReceptionQueueTest, BetweenTwoThreadsNothingIsLostOrSwapped) {
  ReceptionQueue queue(1);
  constexpr Nanoseconds kMessages = 20000;
  std::atomic<bool> done{false};
  std::thread receiving([&] {
    for (Nanoseconds i = 0; i < kMessages; ++i) queue.push(makeReceived(0, i));
    done = true;
  });
  std::vector<Received> taken;
  Nanoseconds expected = 0;
  bool last = false;
  while (!last) {
    last = done;
    queue.take(taken);
    for (const Received& received : taken) ASSERT_EQ(received.steady, expected++);
  }
  receiving.join();
  EXPECT_EQ(expected, kMessages);
  EXPECT_EQ(queue.lost(), std::vector<std::uint64_t>{0});
}

}  // namespace
}  // namespace demo_logger
