#include "src/nodes/keyboard_device.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

TEST(KeyboardDeviceTest, AKeyHoldsItsAxisAndTheEnableButtonForTheHoldTime) {
  KeyboardDevice keyboard({0.6, 0.2, 0.1});
  keyboard.press('w', 0);
  EXPECT_EQ(keyboard.read(599 * kMillisecond).axes, (std::vector<double>{0.5, 0.0, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(keyboard.read(599 * kMillisecond).buttons[0], 1);
  EXPECT_EQ(keyboard.read(600 * kMillisecond).axes, std::vector<double>(6, 0.0));
  EXPECT_EQ(keyboard.read(600 * kMillisecond).buttons[0], 0);
}

TEST(KeyboardDeviceTest, ARepeatingKeyGoesOnHolding) {
  KeyboardDevice keyboard({0.6, 0.2, 0.1});
  keyboard.press('o', 0);
  keyboard.press('o', 500 * kMillisecond);
  EXPECT_EQ(keyboard.read(1000 * kMillisecond).axes[5], -0.5);
}

TEST(KeyboardDeviceTest, TwoAxesMoveTogetherAndTheOppositeKeyTurnsRound) {
  KeyboardDevice keyboard({0.6, 0.2, 0.1});
  keyboard.press('a', 0);
  keyboard.press('r', 0);
  keyboard.press('d', 100 * kMillisecond);
  EXPECT_EQ(keyboard.read(200 * kMillisecond).axes, (std::vector<double>{0.0, -0.5, 0.5, 0.0, 0.0, 0.0}));
}

TEST(KeyboardDeviceTest, PlusAndMinusChangeTheDeflectionWithinItsRange) {
  KeyboardDevice keyboard({0.6, 0.2, 0.25});
  keyboard.press('w', 0);
  keyboard.press('+', 0);
  EXPECT_EQ(keyboard.read(0).axes[0], 0.75);
  for (int i = 0; i < 10; ++i) keyboard.press('+', 0);
  EXPECT_EQ(keyboard.read(0).axes[0], 1.0);
  for (int i = 0; i < 10; ++i) keyboard.press('-', 0);
  EXPECT_EQ(keyboard.read(0).axes[0], 0.25);
}

TEST(KeyboardDeviceTest, SpaceStopsAtOnce) {
  KeyboardDevice keyboard({0.6, 0.2, 0.1});
  keyboard.press('w', 0);
  keyboard.press(' ', 100 * kMillisecond);
  EXPECT_EQ(keyboard.read(100 * kMillisecond).axes, std::vector<double>(6, 0.0));
}

TEST(KeyboardDeviceTest, DigitsAreButtonsForAMoment) {
  KeyboardDevice keyboard({0.6, 0.2, 0.1});
  keyboard.press('3', 0);
  EXPECT_EQ(keyboard.read(199 * kMillisecond).buttons, (std::vector<int>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(keyboard.read(200 * kMillisecond).buttons, std::vector<int>(10, 0));
}

TEST(KeyboardDeviceTest, UnknownKeysDoNothing) {
  KeyboardDevice keyboard({0.6, 0.2, 0.1});
  for (const char key : {'x', '\x1b', '0', '\n'}) keyboard.press(key, 0);
  EXPECT_EQ(keyboard.read(0).axes, std::vector<double>(6, 0.0));
  EXPECT_EQ(keyboard.read(0).buttons, std::vector<int>(10, 0));
}

}  // namespace
}  // namespace demo_logger
