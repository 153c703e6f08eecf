#pragma once

#include "conformance/broken.h"
#include "framework/control/archive.h"

namespace tactus::conformance {

inline constexpr const char* kArchivesTooLittle =
    "restored in the middle of a run it goes on in another way: its doArchive must name all that it carries from one "
    "tick to the next";

/// Saves `from` and restores it into `to`; both have `archive(Archive&)`.
template <class Part>
void takeOver(Part& from, Part& to) {
  control::State state;
  control::Archive saving = control::Archive::saving(state);
  from.archive(saving);
  control::Archive restoring = control::Archive::restoring(state);
  to.archive(restoring);
  if (!restoring.missing().empty())
    throw Broken{"it restores '" + restoring.missing().front() + "', which it does not save"};
  const auto unclaimed = restoring.unclaimed();
  if (!unclaimed.empty()) throw Broken{"it saves '" + unclaimed.front() + "', which it does not restore"};
}

}  // namespace tactus::conformance
