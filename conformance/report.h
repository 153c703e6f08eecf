#pragma once

#include <string>
#include <vector>

namespace tactus::conformance {

enum class Outcome {
  kept,
  broken,
  not_asked                                                        ///< does not concern it; the message says why
};

/// What one law says of one element, or of one instance of it.
struct Finding {
  std::string element;                                             ///< "acme.reach"
  std::string instance;                                            ///< its name in the stack; "" for the element's row
  std::string law;                                                 ///< "jacobian"; see conformance.h
  Outcome outcome = Outcome::kept;
  std::string message;                                             ///< what was found, as a sentence; "" where kept
};

struct Report {
  std::vector<Finding> findings;

  void add(Finding finding) { findings.push_back(std::move(finding)); }
  bool conforms() const;
  /// Below each instance a line for each law that is broken or was not asked, and one for all that are kept.
  std::string text() const;
};

/// "kept", "broken", "not asked".
const char* nameOf(Outcome outcome);

}  // namespace tactus::conformance
