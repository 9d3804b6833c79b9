#pragma once

namespace demo_logger {

/// What is known of a joint's friction, as a share of its Coulomb friction.
struct FrictionShare {
  double mean;
  double variance;
};

/// Of a velocity with a standard deviation. A joint that stands is held by whatever friction it takes, anything from −1
/// to 1: on average 0, with the variance 1/3. One that moves has the share sign(q̇), as far as that is known.
/// Whether it stands is told as a Bayesian tells it, with even odds beforehand: a velocity of 0, or any up to √3 times
/// the `usual_velocity`, its root mean square.
/// With a friction velocity v > 0 the share is tanh(q̇ / v) on average, for no real joint keeps to that while it creeps:
/// what the share lacks of ±1 is uncertain likewise.
FrictionShare frictionShare(double velocity, double deviation, double friction_velocity, double usual_velocity);

}  // namespace demo_logger
