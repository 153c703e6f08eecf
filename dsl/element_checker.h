#pragma once

#include <map>
#include <string>
#include <vector>

#include "dsl/findings.h"
#include "framework/control/element_table.h"
#include "framework/control/element_values.h"

namespace tactus::dsl {

/// An element that the table knows, with its values as far as they are right.
struct CheckedElement {
  const XmlElement* xml = nullptr;
  const control::ElementRow* row = nullptr;
  control::ElementValues values;                                ///< attributes, then classes, then the table's defaults
  bool complete = false;                                    ///< every required value is there and every given one right
  std::vector<CheckedElement> children;

  std::vector<const CheckedElement*> all(std::string_view name) const;
  const CheckedElement* first(std::string_view name) const;
};

/// Its values, with those of the elements inside.
control::ElementValues valuesWithin(const CheckedElement& element);

/// Holds a document against the element table: names, places, counts, attributes and the types of their values.
/// What values refer to is checked later.
class ElementChecker {
 public:
  ElementChecker(const control::ElementTable& table, Findings& findings) : table_(table), findings_(findings) {}

  /// The outermost element of a document, by its own row.
  CheckedElement check(const XmlElement& root);

 private:
  using Prototype = std::map<std::string, control::Value>;         ///< attribute → value
  struct DefaultsClass {
    const XmlElement* xml = nullptr;
    std::string base;
    std::map<std::string, Prototype> prototypes;                   ///< element → values
  };

  void readClasses(const XmlElement& stack);
  void readPrototypes(const XmlElement& defaults, DefaultsClass& into);
  void checkBases();
  CheckedElement checkElement(const XmlElement& element, const control::ElementRow& row);
  void checkChildren(const XmlElement& element, const control::ElementRow& row, CheckedElement& into);
  bool checkGivenAttributes(const XmlElement& element, const control::ElementRow& row, control::ElementValues& values);
  void fillFromClass(const XmlElement& element, control::ElementValues& values);
  bool checkPresence(const XmlElement& element, const control::ElementRow& row, const control::ElementValues& values);
  bool fillDefaults(const XmlElement& element, const control::ElementRow& row, control::ElementValues& values);
  void sayMisplaced(const XmlElement& child, const XmlElement& parent, const std::vector<std::string>& allowed);
  void checkText(const XmlElement& element);
  std::vector<std::string> allowedChildren(const control::ElementRow& row) const;
  const control::ElementRow* backEndOf(const XmlElement& element) const;

  const control::ElementTable& table_;
  Findings& findings_;
  std::map<std::string, DefaultsClass> classes_;
};

}  // namespace tactus::dsl
