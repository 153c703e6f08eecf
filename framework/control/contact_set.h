#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/control/archive.h"

/// What signals hand to tasks: plain data behind typed ports.
namespace tactus::control {

/// A contact as the controller sees it: one a link, or up to ContactSet::per_link.
struct Contact {
  int frame = -1;                                                  ///< index into Model::frames()
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();               ///< m
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();              ///< unit, out of the robot into the object
  double force_N = 0;                                              ///< measured, along the normal
  int number = 0;                                                  ///< < per_link; the same for as long as it lasts
};

/// Contacts of this tick; at most `capacity`, in the order of the robot's links.
struct ContactSet {
  int capacity = 0;
  int per_link = 1;                                                ///< contacts of one link at most
  std::vector<Contact> contacts;                                   ///< reserved to capacity
};

/// A desired contact that is missing: a point fixed to a link that should come to touch.
struct MissingContact {
  int frame = -1;
  int slot = 0;                                                    ///< stable index of the link among the desired ones
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
};

struct MissingSet {
  int capacity = 0;
  std::vector<MissingContact> points;                              ///< this tick's, in slot order
  /// All current contacts, desired or not: what 4.4.1 looks for the closest point in.
  const std::vector<Contact>* all_contacts = nullptr;
};

/// A feature found by touch.
struct FeatureEstimate {
  bool found = false;
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();            ///< m; for a bump: its highest point
  double height = 0;                                               ///< m above the surface around it
  int points = 0;                                                  ///< touched points that the estimate rests on
};

/// Where something should go next.
struct Place {
  bool known = false;                                              ///< false: nowhere in particular
  int number = 0;                                                  ///< rises with each new place
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();            ///< m
  Eigen::Vector3d heading_W = Eigen::Vector3d::Zero();             ///< where to point on the way; zero: anywhere
};

/// A fixed set of links, e.g. those that a contacts signal calls desired.
struct FrameSet {
  std::vector<int> frames;                                         ///< indices into Model::frames(), rising
};

/// Points touched so far.
struct TouchedPoint {
  double time = 0;
  int frame = -1;
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();
  double force_N = 0;
};
struct TouchedPoints {
  std::vector<TouchedPoint> points;                                ///< reserved; stops growing when full
};
void archive(Archive& archive, TouchedPoints& points);
void archive(Archive& archive, FeatureEstimate& estimate);
void archive(Archive& archive, Place& place);

/// The name that a port of this type carries in the element table.
template <class T>
struct PortType;
template <>
struct PortType<ContactSet> { static constexpr const char* name = "contact-set"; };
template <>
struct PortType<MissingSet> { static constexpr const char* name = "missing-set"; };
template <>
struct PortType<TouchedPoints> { static constexpr const char* name = "touched-points"; };
template <>
struct PortType<FeatureEstimate> { static constexpr const char* name = "feature"; };
template <>
struct PortType<FrameSet> { static constexpr const char* name = "frame-set"; };
template <>
struct PortType<Place> { static constexpr const char* name = "place"; };
template <>
struct PortType<double> { static constexpr const char* name = "scalar"; };
template <>
struct PortType<Eigen::VectorXd> { static constexpr const char* name = "vector"; };

}  // namespace tactus::control
