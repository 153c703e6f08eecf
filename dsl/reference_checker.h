#pragma once

#include <string>
#include <vector>

#include "dsl/element_checker.h"
#include "dsl/stack.h"

namespace tactus::dsl {

/// Holds the values of checked elements against what they name: links, joints, objects, signals' ports.
class ReferenceChecker {
 public:
  /// Without a robot (its file is wrong) links and joints are not checked.
  ReferenceChecker(const Stack& stack, bool robot_known, Findings& findings)
      : stack_(stack), robot_known_(robot_known), findings_(findings) {}

  void check(const CheckedElement& element);
  /// The element and those inside.
  void checkAll(const CheckedElement& element);
  /// Signals that nothing reads and that read nothing themselves.
  void warnOfUnusedSignals(const std::vector<const CheckedElement*>& signals);

 private:
  void checkValue(const CheckedElement& element, const control::AttributeRow& row);
  void checkPort(const CheckedElement& element, const control::AttributeRow& row);
  void checkWords(const CheckedElement& element, const control::AttributeRow& row,
                  const std::vector<std::string>& names, const Code& unknown, const std::string& what);
  void say(const Code& code, const CheckedElement& element, const control::AttributeRow& row,
           const std::string& message, const std::string& suggestion = "", std::size_t word = 0);

  const Stack& stack_;
  bool robot_known_;
  Findings& findings_;
  std::vector<std::string> read_signals_;
};

}  // namespace tactus::dsl
