// A plugin that registers one back end, and that is wrong in the one way that `fault` says.  It is compiled once and
// linked with one small source for each fault.

#include <stdexcept>
#include <string_view>

#include "framework/runtime/plugin_api.h"

extern const char* const fault;

namespace {

using namespace tactus;

class Idle final : public control::BackEnd {
 public:
  Idle() : BackEnd({}) {}

 private:
  void doPrepare(const control::TickProblem&) override {}
  void doSolve(const control::TickProblem&, control::TickSolution&) override {}
};

void addIdle(control::Registry& registry, const std::string& name) {
  control::ElementRow row;
  row.name = name;
  row.kind = control::ElementKind::back_end;
  row.description = "Does nothing.";
  registry.addBackEnd(row, [](const control::ElementValues&) { return std::make_unique<Idle>(); });
}

void registerElements(control::Registry& registry) {
  const std::string_view wrong = fault;
  if (wrong == "duplicate" || wrong == "halfway") {
    addIdle(registry, std::string(fault) + ".idle");
  } else {
    addIdle(registry, wrong == "bare" ? "idle" : wrong == "stranger" ? "other.idle" : "good.idle");
  }
  if (wrong == "duplicate") addIdle(registry, "duplicate.idle");
  if (wrong == "halfway") addIdle(registry, "halfway.taken");
  if (wrong == "standard_throw") throw std::runtime_error("the licence server is on holiday");
  if (wrong == "other_throw") throw 7;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const tactus::runtime::PluginDescriptor* tactus_plugin() {
  static tactus::runtime::PluginDescriptor descriptor{tactus::runtime::plugin_magic,
                                                      tactus::runtime::plugin_abi,
                                                      sizeof(tactus::runtime::PluginDescriptor),
                                                      TACTUS_VERSION,
                                                      TACTUS_COMPILER_ID,
                                                      TACTUS_EIGEN_VERSION,
                                                      EIGEN_MAX_ALIGN_BYTES,
                                                      "good",
                                                      "1.2.3",
                                                      "BSD-3-Clause",
                                                      registerElements};
  const std::string_view wrong = fault;
  if (wrong == "entry_throw") throw std::runtime_error("the dongle is missing");
  if (wrong == "entry_throw_other") throw 7;
  if (wrong == "nodescriptor") return nullptr;
  if (wrong == "magic") descriptor.magic = 0x6d616c6963650001;
  if (wrong == "abi") descriptor.abi = 99;
  if (wrong == "size") descriptor.size = 8;
  if (wrong == "framework") descriptor.framework_version = "0.0.1";
  if (wrong == "compiler") descriptor.compiler = "clang 99";
  if (wrong == "eigen") descriptor.eigen_version = 30309;
  if (wrong == "align") descriptor.eigen_max_align = 64;
  if (wrong == "noname") descriptor.name = "";
  if (wrong == "nullcompiler") descriptor.compiler = nullptr;
  if (wrong == "nullversion") descriptor.version = nullptr;
  if (wrong == "nulllicence") descriptor.licence = nullptr;
  if (wrong == "noregister") descriptor.register_elements = nullptr;
  if (wrong == "duplicate" || wrong == "halfway") descriptor.name = fault;
  return &descriptor;
}
