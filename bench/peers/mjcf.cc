#include "bench/peers/mjcf.h"

#include <Eigen/Eigenvalues>
#include <sstream>
#include <vector>

namespace tactus::bench {
namespace {

using description::JointType;

std::string attribute(const std::string& name, std::initializer_list<double> values) {
  std::ostringstream text;
  text.precision(17);
  text << ' ' << name << "=\"";
  const char* separator = "";
  for (const double value : values) {
    text << separator << value;
    separator = " ";
  }
  text << '"';
  return text.str();
}

std::string attribute(const std::string& name, const Eigen::Vector3d& v) {
  return attribute(name, {v.x(), v.y(), v.z()});
}

std::string quaternion(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond turn(R);
  return attribute("quat", {turn.w(), turn.x(), turn.y(), turn.z()});
}

std::string inertial(const Body& body) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(body.inertia);
  Eigen::Matrix3d axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  return "<inertial" + attribute("pos", body.centre_of_mass) + quaternion(axes) + attribute("mass", {body.mass}) +
         attribute("diaginertia", principal.eigenvalues()) + "/>";
}

std::string joint(const Body& body) {
  return body.type == JointType::floating ? "<freejoint/>" : "<joint type=\"hinge\" axis=\"0 0 1\"/>";
}

}  // namespace

std::string mjcf(const Problem& problem) {
  std::ostringstream text;
  text << "<mujoco><compiler angle=\"radian\"/><option" << attribute("gravity", problem.gravity_W) << "/><worldbody>\n";
  std::vector<int> open;                                           // bodies are depth-first: a stack of open elements
  const auto closeDownTo = [&](int parent) {
    while (!open.empty() && open.back() != parent) {
      text << "</body>\n";
      open.pop_back();
    }
  };
  for (int i = 0; i < static_cast<int>(problem.bodies.size()); ++i) {
    const Body& body = problem.bodies[i];
    closeDownTo(body.parent);
    text << "<body name=\"" << i << '"' << attribute("pos", body.origin.translation())
         << quaternion(body.origin.linear()) << '>' << joint(body) << inertial(body) << '\n';
    open.push_back(i);
  }
  closeDownTo(-1);
  text << "</worldbody></mujoco>\n";
  return text.str();
}

}  // namespace tactus::bench
