#pragma once

#include <string>
#include <vector>

#include "dsl/element_checker.h"
#include "dsl/stack.h"

namespace tactus::dsl {

/// Holds the values of checked elements against what they name: links, joints, objects, signals' ports.
class ReferenceChecker {
 public:
  /// `robot` and `scene_known` say whether the robot and the scene could be read: what is not known is not checked.
  ReferenceChecker(const Stack& stack, bool robot_known, bool signals_known, Findings& findings)
      : stack_(stack), robot_known_(robot_known), signals_known_(signals_known), findings_(findings) {}

  void check(const CheckedElement& element);
  /// Signals that nothing reads and that read nothing themselves.
  void warnOfUnusedSignals(const std::vector<const CheckedElement*>& signals);

 private:
  void checkValue(const CheckedElement& element, const control::AttributeRow& row);
  void checkPort(const CheckedElement& element, const control::AttributeRow& row);
  void checkWords(const CheckedElement& element, const control::AttributeRow& row,
                  const std::vector<std::string>& names, const Code& unknown, const std::string& what);
  void say(const Code& code, const CheckedElement& element, const control::AttributeRow& row,
           const std::string& message, const std::string& suggestion = "");

  const Stack& stack_;
  bool robot_known_;
  bool signals_known_;
  Findings& findings_;
  std::vector<std::string> read_signals_;
};

}  // namespace tactus::dsl
