// A plugin whose task goes wrong in the way, and from the time on, that the stack says.

#include <limits>
#include <stdexcept>

#include "framework/runtime/plugin_api.h"

namespace {

using namespace tactus::control;

class Naughty final : public Task {
 public:
  explicit Naughty(const BuildContext& context)
      : Task(Relation::equality, context.values.text("fault") == "capacity" ? -1 : 1),
        fault_(context.values.text("fault")),
        from_(context.values.real("from")) {}

 private:
  void doUpdate(const Tick& tick, TickTask& rows) override {
    rows.rows = 1;
    rows.jacobian.row(0).setZero();
    rows.jacobian(0, 0) = 1;
    rows.force[0] = 0;
    if (tick.time < from_) return;
    if (fault_ == "nan") rows.force[0] = std::numeric_limits<double>::quiet_NaN();
    if (fault_ == "huge") rows.force[0] = 1e308;
    if (fault_ == "throw") throw std::runtime_error("the licence server is on holiday");
    if (fault_ == "throw-other") throw 7;
    if (fault_ == "rows") rows.rows = 5;
    if (fault_ == "resize") rows.jacobian.resize(2, 2);
  }
  std::string fault_;
  double from_;
};

void registerElements(Registry& registry) {
  ElementRow row;
  row.name = "naughty.task";
  row.description = "Goes wrong.";
  row.attributes = {{.name = "fault", .type = ValueType::choice, .required = true,
                     .choices = {"capacity", "nan", "huge", "throw", "throw-other", "rows", "resize"}},
                    {.name = "from", .type = ValueType::real, .unit = "s", .default_text = "0.0205"}};
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<Naughty>(context); });
}

}  // namespace

TACTUS_PLUGIN("naughty", "1.0.0", "BSD-3-Clause", registerElements)
