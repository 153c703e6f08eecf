#include "plugins/grasp/grasp_wrench_space.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace tactus::plugins {
namespace {

/// Singular values below this share of the largest are none.
constexpr double rank_tolerance = 1e-9;

void check(const GraspWrenchOptions& options) {
  if (!(options.friction >= 0) || !std::isfinite(options.friction))
    throw std::invalid_argument("friction is finite and at least 0");
  if (options.edges < 3) throw std::invalid_argument("a cone has at least 3 edges");
  if (!options.centre.allFinite()) throw std::invalid_argument("the centre is finite");
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    throw std::invalid_argument("the scale is finite and greater than 0");
}

/// Qhull's own messages, in memory.
class Messages {
 public:
  Messages() : file_(::open_memstream(&text_, &size_)) {
    if (!file_) throw HullError("no memory for the messages of Qhull");
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  ~Messages() {
    std::fclose(file_);
    std::free(text_);
  }
  FILE* file() { return file_; }
  std::string firstLine() {
    std::fflush(file_);
    const std::string all(text_, size_);
    return all.substr(0, all.find('\n'));
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  FILE* file_;
};

/// Frees what Qhull has allocated, however a call of it ends.
class Qhull {
 public:
  explicit Qhull(FILE* messages) { qh_zero(&qh, messages); }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    qh_freeqhull(&qh, !qh_ALL);
    int bytes_left = 0, pieces_left = 0;
    qh_memfreeshort(&qh, &bytes_left, &pieces_left);
  }
  qhT qh;
};

}  // namespace

Eigen::Matrix<double, 6, Eigen::Dynamic> primitiveWrenches(const std::vector<GraspContact>& contacts,
                                                           const GraspWrenchOptions& options) {
  check(options);
  Eigen::Matrix<double, 6, Eigen::Dynamic> wrenches(6, static_cast<Eigen::Index>(contacts.size()) * options.edges);
  Eigen::Index column = 0;
  for (const GraspContact& contact : contacts) {
    const double length = contact.normal.norm();
    if (!contact.position.allFinite() || !std::isfinite(length))
      throw std::invalid_argument("positions and normals are finite");
    if (!(length > 0)) throw std::invalid_argument("a normal has a length");
    const Eigen::Vector3d n = contact.normal / length;
    const Eigen::Vector3d axis = std::abs(n.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    const Eigen::Vector3d t1 = n.cross(axis).normalized(), t2 = n.cross(t1);
    for (int k = 0; k < options.edges; ++k, ++column) {
      const double theta = 2 * std::numbers::pi * k / options.edges;
      const Eigen::Vector3d force = n + options.friction * (std::cos(theta) * t1 + std::sin(theta) * t2);
      wrenches.col(column) << force, (contact.position - options.centre).cross(force) / options.scale;
    }
  }
  return wrenches;
}

GraspWrenchSpace graspWrenchSpace(const std::vector<GraspContact>& contacts, const GraspWrenchOptions& options) {
  const Eigen::Matrix<double, 6, Eigen::Dynamic> wrenches = primitiveWrenches(contacts, options);
  GraspWrenchSpace space;
  if (wrenches.cols() == 0) return space;
  const Eigen::VectorXd sizes = Eigen::JacobiSVD<Eigen::MatrixXd>(wrenches).singularValues();
  space.rank = static_cast<int>((sizes.array() > rank_tolerance * sizes[0]).count());
  if (space.rank < 6) return space;

  Eigen::Matrix<double, 6, Eigen::Dynamic> points(6, wrenches.cols() + 1);
  points << wrenches, Eigen::Matrix<double, 6, 1>::Zero();
  Messages messages;
  Qhull hull(messages.file());
  char arguments[] = "qhull Qt";
  const int code = qh_new_qhull(&hull.qh, 6, static_cast<int>(points.cols()), points.data(), False, arguments, nullptr,
                                messages.file());
  if (code != 0) throw HullError("the hull of the wrenches could not be found: " + messages.firstLine());
  qh_getarea(&hull.qh, hull.qh.facet_list);
  space.volume = hull.qh.totvol;
  double nearest = std::numeric_limits<double>::infinity();
  for (const facetT* facet = hull.qh.facet_list; facet && facet->next; facet = facet->next)
    nearest = std::min(nearest, -facet->offset);                   // normals point out: offset < 0 where 0 is inside
  space.epsilon = std::max(0.0, nearest);
  return space;
}

}  // namespace tactus::plugins
