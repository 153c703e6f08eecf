#include "conformance/report.h"

#include <algorithm>
#include <utility>

namespace tactus::conformance {
namespace {

bool isOfOneSubject(const Finding& a, const Finding& b) { return a.element == b.element && a.instance == b.instance; }

}  // namespace

const char* nameOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kept: return "kept";
    case Outcome::broken: return "broken";
    case Outcome::not_asked: return "not asked";
  }
  return "";
}

bool Report::conforms() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& finding) { return finding.outcome == Outcome::broken; });
}

std::string Report::text() const {
  std::string text, kept;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const Finding& finding = findings[i];
    const bool first = i == 0 || !isOfOneSubject(findings[i - 1], finding);
    const std::string instance = finding.instance.empty() ? "" : " '" + finding.instance + "'";
    if (first) text += "<" + finding.element + ">" + instance + "\n";
    if (finding.outcome == Outcome::kept) kept += (kept.empty() ? "" : ", ") + finding.law;
    else text += std::string("  ") + nameOf(finding.outcome) + ": " + finding.law + ": " + finding.message + "\n";
    const bool last = i + 1 == findings.size() || !isOfOneSubject(finding, findings[i + 1]);
    if (last && !kept.empty()) text += "  kept: " + std::exchange(kept, "") + "\n";
  }
  return text;
}

}  // namespace tactus::conformance
