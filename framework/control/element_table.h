#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// The one table that says what may stand in a stack: elements, attributes, types, units, defaults, ranges.
/// Built-ins and plugins add rows by the same call; reading, defaults, checks, the XSD and the manual come from it.
namespace tactus::control {

enum class ValueType {
  text,                                                            ///< any string
  identifier,                                              ///< a new name: letters, digits, '_' and '-'; a letter first
  flag,                                                            ///< true | false
  integer,
  real,
  reals,                                                           ///< numbers separated by blanks
  points,                                                          ///< groups of `count` reals separated by ';'
  choice,                                                          ///< one of `choices`
  port,                                                            ///< signal.port, of the row's `port_type`
  link,                                                            ///< a link of the robot
  links,                                                           ///< link or link-group names separated by blanks
  joints,                                                          ///< joint or joint-group names separated by blanks
  object,                                                          ///< an object of the scene
  element_class,                                                   ///< a <defaults> class
  file                                                             ///< a file or model name
};

/// What numbers in world axes are: what becomes of them where the whole world is turned and moved.
enum class InWorld {
  no,                                                              ///< gains, lengths, values in a link's axes
  positions,                                                       ///< groups of 3
  directions,                                                      ///< groups of 3
  orientation,                                                     ///< roll, pitch, yaw about fixed axes
  matrix                                                           ///< 3×3 by rows, from a vector to a vector
};

struct AttributeRow {
  std::string name;
  ValueType type = ValueType::text;
  std::string unit = {};                                           ///< "N", "m", "N m/rad", "1"; "" for what has none
  std::optional<std::string> default_text = {};                         ///< as it would be written
  bool required = false;
  std::string description = {};
  double lower = -std::numeric_limits<double>::infinity();         ///< each number ≥ lower (> when lower_open)
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  int count = 0;                               ///< numbers in `reals`, in a group of `points`, behind a `port`; 0 = any
  InWorld in_world = InWorld::no;
  std::vector<std::string> choices = {};                   ///< for `choice`; for joints, links, ports: extra words
  std::string port_type = {};                                           ///< for `port`
  /// Of places in the world: the `link` attribute whose link is to reach them, for `check --strict`; "" = none.
  std::string reached_by = {};
  std::string since = {};                                  ///< version that brought it; "" = it was there from the start
  std::string deprecated = {};                             ///< what to write instead, a sentence; "" = it is not
  std::vector<std::string> formerly = {};                  ///< older names: read with a warning, rewritten by migrate
};

/// What holds between attributes of one element; a value that only the table gives counts as not given.
enum class Presence {
  exclusive,                                                       ///< at most one of them
  together,                                                        ///< all of them or none
  any_of,                                                          ///< at least one
  one_of,                                                          ///< exactly one
  needs                                                            ///< the first needs all the others
};

struct PresenceRule {
  Presence kind = Presence::exclusive;
  std::vector<std::string> attributes;                             ///< at least two
};

struct ElementRow;

struct ChildRow {
  std::string element;                                      ///< name, or "@task", "@signal", "@shape", … for all of a kind
  int min = 0;
  int max = -1;                                                    ///< -1 = any number

  bool allows(const ElementRow& row) const;
};

/// An output that a signal or a sensor offers, written name.port.
struct PortRow {
  std::string name;                                                ///< "@child": one for each child of that name
  std::string type;                                                ///< "scalar", "vector", "contact-set", "feature", …
  std::string unit;                                                ///< "" for what has none, or more than one
  std::string description = {};
  int dimension = 0;                                               ///< numbers of a value; 0 = as many as there are
};

enum class ElementKind { structure, shape, sensor, signal, task, controller, measure, recorder, back_end };

struct ElementRow {
  std::string name;
  ElementKind kind = ElementKind::structure;
  std::string description = {};
  std::string source = {};                                              ///< equation or paper, "" when it has none
  std::vector<AttributeRow> attributes = {};
  std::vector<ChildRow> children = {};
  std::vector<PortRow> ports = {};                         ///< of signals; of sensors, "scalar" or "vector"
  std::vector<PresenceRule> presence = {};
  std::string since = {};                                               ///< as for attributes
  std::string deprecated = {};
  std::vector<std::string> formerly = {};
  bool takes_back_end_options = false;                                  ///< those of the one that `backend` names

  const AttributeRow* attribute(std::string_view name) const;
  /// The attribute that once had this name, or null.
  const AttributeRow* formerAttribute(std::string_view name) const;
};

class ElementTable {
 public:
  /// Throws std::invalid_argument when the name is taken or a row contradicts itself (its default is out of range, …).
  void add(ElementRow row);
  /// Back ends are looked up apart: their rows are the extra attributes of elements that take back-end options.
  const ElementRow* find(std::string_view name) const;
  const ElementRow* findBackEnd(std::string_view name) const;
  /// The element, no back end, that once had this name, or null.
  const ElementRow* findFormer(std::string_view name) const;
  const std::deque<ElementRow>& rows() const { return rows_; }

 private:
  std::deque<ElementRow> rows_;
};

}  // namespace tactus::control
