#include "bench/peers/engine.h"

#ifndef TACTUS_BENCH_MUJOCO
#define TACTUS_BENCH_MUJOCO 0
#endif
#ifndef TACTUS_BENCH_KDL
#define TACTUS_BENCH_KDL 0
#endif
#ifndef TACTUS_BENCH_DART
#define TACTUS_BENCH_DART 0
#endif
#ifndef TACTUS_BENCH_SIMBODY
#define TACTUS_BENCH_SIMBODY 0
#endif

namespace tactus::bench {

// A null pointer: this engine cannot be told the problem.
std::vector<std::unique_ptr<Engine>> makeEngines(const Problem& problem) {
  std::vector<std::unique_ptr<Engine>> engines;
  engines.push_back(makeTactus(problem));
#if TACTUS_BENCH_MUJOCO
  engines.push_back(makeMujoco(problem));
#endif
#if TACTUS_BENCH_KDL
  engines.push_back(makeKdl(problem));
#endif
#if TACTUS_BENCH_DART
  engines.push_back(makeDart(problem));
#endif
#if TACTUS_BENCH_SIMBODY
  engines.push_back(makeSimbody(problem));
#endif
  std::erase(engines, nullptr);
  return engines;
}

std::vector<std::string> absentEngines() {
  std::vector<std::string> absent;
  if (!TACTUS_BENCH_MUJOCO) absent.push_back("MuJoCo (libmujoco-dev)");
  if (!TACTUS_BENCH_KDL) absent.push_back("Orocos KDL (liborocos-kdl-dev)");
  if (!TACTUS_BENCH_DART) absent.push_back("DART (libdart-dev)");
  if (!TACTUS_BENCH_SIMBODY) absent.push_back("Simbody (libsimbody-dev)");
  return absent;
}

}  // namespace tactus::bench
