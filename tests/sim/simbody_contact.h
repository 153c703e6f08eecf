#pragma once

#include <array>

/// What Simbody's own tracker and compliant contact say of a ball that touches another one, or the half space z < 0.
/// Plain numbers: Simbody 3.7's headers of contact are not C++20 (operator== of its indices), so what is behind this is
/// compiled as C++17.
namespace tactus::sim_tests {

using Triple = std::array<double, 3>;

struct MovingBall {
  double radius;                                                   // m
  Triple place_W, linear_W, angular_W;
};

struct SimbodyMaterial {
  double modulus, dissipation, friction;                           // Pa, s/m; static and dynamic friction alike
};

struct SimbodyTouch {
  int count;                                                       // of contacts; the rest is that of the first
  double depth;
  Triple point_W, normal_W;                                        // from the ball into the other
  Triple force_W;                                                  // on the other
};

/// Both have the material; no second one: the half space.
SimbodyTouch simbodyContact(const MovingBall& ball, const MovingBall* second, const SimbodyMaterial& material);

}  // namespace tactus::sim_tests
