#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/description/robot.h"

namespace tactus::dynamics {

/// Which links of a robot are to touch each other.
struct SelfContact {
  /// Two links that do not, and why: a part of a sentence.
  struct LeftOut {
    description::LinkPair links;
    std::string why;
  };
  std::vector<description::LinkPair> touching;                     ///< rising, as Robot::self_contact
  std::vector<LeftOut> left_out;                                   ///< rising
};

/// Of all pairs of `links` that have shapes, those whose touching is meant.  Left out are
/// - links of one body, held together by fixed joints, and of two bodies that one moving joint joins: their shapes
///   overlap about the joint by design;
/// - links whose shapes overlap at q: two links of one robot cannot, so the shapes are rounder or longer there than
///   what they stand for.
/// `q` has an entry for each position of the robot.  Throws ModelError where the robot is none.
SelfContact findSelfContact(const description::Robot& robot, const Eigen::VectorXd& q, const std::vector<int>& links);

/// How far the surfaces of two links' shapes are apart, below 0 where they overlap (then the depth, as far as an edge
/// or an axis of one in the other tells it); infinite where one has no shape.
double gapBetween(const description::Link& one, const Eigen::Isometry3d& X_WOne, const description::Link& other,
                  const Eigen::Isometry3d& X_WOther);

}  // namespace tactus::dynamics
