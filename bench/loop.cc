// The whole loop: plant and controller in turn, the hand pressing balls with twelve links.  How many seconds are
// simulated in a second of one core, and where the time goes.  docs/benchmarks.md says how to read it.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <variant>

#include "bench/tick_cases.h"
#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "framework/dynamics/dynamics_cache.h"
#include "framework/geometry/primitives.h"
#include "framework/runtime/contact_metrics.h"
#include "sim/simbody_plant.h"

namespace {

using namespace tactus;
using Clock = std::chrono::steady_clock;

constexpr const char* stack_file = TACTUS_SOURCE_DIR "/bench/stacks/hand_in_balls.xml";
constexpr double wanted_factor = 4;
constexpr int wanted_contacts = 12;

dsl::Stack read(const std::string& back_end) {
  dsl::ReadOptions options;
  options.model_path = {TACTUS_SOURCE_DIR "/models"};
  const size_t slash = back_end.find('/');
  options.backend = back_end.substr(0, slash);
  if (slash != std::string::npos) options.backend_options["solver"] = back_end.substr(slash + 1);
  return dsl::readStack(stack_file, bench::registry(), options);
}

/// A ball against the inner side of each desired link, half a millimetre deep.
void addBalls(const dsl::Stack& stack, const std::vector<int>& links, const dynamics::Model& model,
              description::Scene& scene) {
  constexpr double radius = 0.012, depth = 0.0005;
  dynamics::DynamicsCache robot(model, scene.gravity);
  robot.update(stack.start_q, Eigen::VectorXd::Zero(model.dof()));
  for (const int link : links) {
    const auto& capsule = std::get<description::CapsuleShape>(stack.robot.links[static_cast<size_t>(link)].shapes.front());
    const Eigen::Vector3d middle = 0.5 * (capsule.from + capsule.to);
    description::Object ball;
    ball.name = "ball_" + stack.robot.links[static_cast<size_t>(link)].name;
    ball.pose.translation() =
        robot.framePose(link) * Eigen::Vector3d(middle + (capsule.radius + radius - depth) * Eigen::Vector3d::UnitX());
    ball.primitives.push_back({std::make_shared<geometry::Sphere>(radius), Eigen::Isometry3d::Identity()});
    scene.objects.push_back(std::move(ball));
  }
}

struct Loop {
  double simulated = 0, plant = 0, controller = 0;                 // s
  double links = 0, records = 0;                                   // mean
  double factor() const { return simulated / (plant + controller); }
};

Loop run(const std::string& back_end, double duration) {
  const dsl::Stack stack = read(back_end);
  const auto controller = dsl::compile(stack, bench::registry());
  const std::vector<int> links =
      static_cast<const control::FrameSet*>(controller->signals().front().signal->port("desired"))->frames;
  description::Scene scene = stack.scene(stack.run.seed);
  addBalls(stack, links, controller->model(), scene);
  sim::SimbodyPlant plant(stack.robot, scene, stack.start_q);
  runtime::ContactMetrics contacts(static_cast<int>(stack.robot.links.size()), static_cast<int>(scene.objects.size()), links);
  const auto seconds = [](Clock::duration span) { return std::chrono::duration<double>(span).count(); };
  Loop loop;
  const long ticks = std::lround(duration / controller->period());
  for (long tick = 0; tick < ticks; ++tick) {
    contacts.update(plant.sense().contacts, controller->period());
    loop.links += contacts.now().contacts;
    loop.records += static_cast<double>(plant.sense().contacts.size());
    const auto start = Clock::now();
    const Eigen::VectorXd& torque = controller->tick(plant.sense());
    const auto between = Clock::now();
    plant.advance(torque, controller->period());
    const auto end = Clock::now();
    loop.controller += seconds(between - start);
    loop.plant += seconds(end - between);
  }
  loop.simulated = duration;
  loop.links /= static_cast<double>(ticks);
  loop.records /= static_cast<double>(ticks);
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times the whole loop of plant and controller with twelve contacts\nExample: taskset -c 1 bench_loop");
  double duration = 5;
  std::vector<std::string> back_ends{"null-space", "qp/active-set", "hqp"};
  app.add_option("--duration", duration, "Simulated time of each run, s");
  app.add_option("--backend", back_ends, "Back ends; of qp with its solver");
  CLI11_PARSE(app, argc, argv);
  std::printf("%-14s %10s %9s %12s %12s\n", "back end", "x real", "links", "plant us", "controller us");
  bool good = false;
  for (const std::string& back_end : back_ends) {
    const Loop loop = run(back_end, duration);
    const double ticks = loop.simulated * 1e3;
    std::printf("%-14s %10.2f %9.2f %12.1f %12.1f\n", back_end.c_str(), loop.factor(), loop.links, 1e6 * loop.plant / ticks,
                1e6 * loop.controller / ticks);
    good = good || (loop.factor() >= wanted_factor && loop.links >= wanted_contacts - 0.5);
  }
  std::printf("wanted: %g x real time with %d links in contact: %s\n", wanted_factor, wanted_contacts, good ? "met" : "missed");
  return 0;
}
