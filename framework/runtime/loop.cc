#include "framework/runtime/loop.h"

#include <chrono>
#include <cmath>

#include "framework/runtime/file_error.h"
#include "framework/runtime/part_error.h"

namespace tactus::runtime {
namespace {

void endWith(Ending ending, const std::exception& error, LoopResult& result) {
  result.ending = ending;
  result.message = error.what();
  result.error = std::current_exception();
}

/// The tick; one that throws is shown to the observers first.
const Eigen::VectorXd& tickOf(control::Controller& controller, const control::Sensed& sensed,
                              const std::vector<control::Observer*>& observers) {
  try {
    return controller.tick(sensed);
  } catch (const control::TickError& error) {
    for (control::Observer* observer : observers) observer->broken({sensed, controller, error});
    throw;
  }
}

}  // namespace

LoopResult runLoop(Plant& plant, control::Controller& controller, double duration,
                   const std::vector<control::Observer*>& observers, const std::atomic<bool>& stop) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  using Microseconds = std::chrono::duration<double, std::micro>;

  const long ticks = std::lround(duration / controller.period());
  const auto start = Clock::now();
  LoopResult result;
  try {
    for (; result.ticks < ticks; ++result.ticks) {
      if (stop.load(std::memory_order_relaxed)) {
        result.ending = Ending::interrupted;
        result.message = "interrupted";
        break;
      }
      const control::Sensed& sensed = plant.sense();
      for (control::Observer* observer : observers) observer->before(controller);
      const auto before = Clock::now();
      const Eigen::VectorXd& torque = tickOf(controller, sensed, observers);
      const double tick_us = Microseconds(Clock::now() - before).count();
      for (control::Observer* observer : observers) observer->observe({plant.truth(), sensed, controller, torque, tick_us, plant.objects()});
      plant.advance(torque, controller.period());
    }
  } catch (const PlantError& error) {
    endWith(Ending::plant_error, error, result);
  } catch (const control::TickError& error) {
    endWith(Ending::tick_error, error, result);
  } catch (const PartError& error) {
    endWith(Ending::part_error, error, result);
  } catch (const FileError& error) {
    endWith(Ending::file_error, error, result);
  }
  result.simulated = static_cast<double>(result.ticks) * controller.period();
  result.wall_clock = Seconds(Clock::now() - start).count();
  return result;
}

}  // namespace tactus::runtime
