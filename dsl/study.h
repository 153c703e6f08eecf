#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/description/place.h"

namespace tactus::dsl {

/// A parameter of the stack and the values that it takes in turn.
struct StudyFactor {
  std::string parameter;
  std::vector<std::string> values;                                 ///< as --set takes them
  description::Place place;                                        ///< of the parameter's name
  description::Place values_place;
};

/// Figures of one metric under two conditions that differ in one factor alone, seed by seed.
struct StudyComparison {
  std::string metric;
  std::string by;                                                  ///< "backend" or a parameter
  std::string baseline;                                            ///< the level that all others are held against
  std::vector<std::string> over = {};                              ///< factors whose pairs count together
};

/// A name and where it is written.
struct PlacedName {
  std::string name;
  description::Place place;
};

/// A study, read and checked by itself; what it says of its stack is checked where the stack is read.
struct Study {
  std::string name;
  std::string file;
  std::string stack;                                               ///< path of its stack
  std::optional<double> duration;                                  ///< s; none: the stack's
  bool keeps_runs = true;                                          ///< whole run folders, not their figures alone
  std::vector<StudyFactor> factors;
  std::vector<PlacedName> back_ends;                               ///< as --backend takes them; none: the stack's own
  std::uint64_t first_seed = 1;
  int seeds = 1;
  std::vector<PlacedName> metrics;                                 ///< to report; none: all
  std::vector<StudyComparison> comparisons;
  std::map<std::string, std::string> files;                        ///< every file read → its content
};

}  // namespace tactus::dsl
