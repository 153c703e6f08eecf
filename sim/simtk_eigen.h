#pragma once

#ifdef NDEBUG
#error "Simbody's headers change their class layout on NDEBUG, and Debian's library is built without it"
#endif

#include <Eigen/Geometry>
#include <concepts>

// C++20 also tries every comparison the other way round, which makes those of Simbody's index types, each with many
// operator==(some integer), ambiguous with their own reverse.  An exact match, known before its headers, settles it.
namespace SimTK {
template <class Index>
  requires requires(const Index& i) { { i.isValidExtended() } -> std::same_as<bool>; }
bool operator==(const Index& a, const Index& b) { return static_cast<int>(a) == static_cast<int>(b); }
}  // namespace SimTK
#include <Simbody.h>

/// Simbody, and the way between its types and Eigen's.  For the sources of `sim`, tests and benchmarks only.
namespace tactus::sim {

inline SimTK::Vec3 toSimTK(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline SimTK::Mat33 toSimTK(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
inline SimTK::Transform toSimTK(const Eigen::Isometry3d& X) {
  return {SimTK::Rotation(toSimTK(Eigen::Matrix3d(X.linear())), true), toSimTK(Eigen::Vector3d(X.translation()))};
}

inline Eigen::Vector3d toEigen(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }
inline Eigen::Matrix3d toEigen(const SimTK::Rotation& R) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = R[i][j];
  return m;
}
inline Eigen::Map<const Eigen::VectorXd> toEigen(const SimTK::Vector& v) {
  return {v.size() ? v.getContiguousScalarData() : nullptr, v.size()};
}
inline Eigen::Map<Eigen::VectorXd> toEigen(SimTK::Vector& v) {
  return {v.size() ? v.updContiguousScalarData() : nullptr, v.size()};
}

}  // namespace tactus::sim
