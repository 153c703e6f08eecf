#pragma once

#include <string>
#include <vector>

namespace tactus::dsl {

/// Where a robot model was found, or where it was looked for.
struct ModelSearch {
  std::string file;                                                ///< "" = not found
  std::vector<std::string> tried;
  std::vector<std::string> names;                                  ///< models that there are in the folders
};

/// A model by name ("lwr_allegro" → lwr_allegro.urdf) in the folder of `from` and then in `folders`; a name that
/// ends in ".urdf" is a file relative to the folder of `from`, then to those.
ModelSearch findModel(const std::string& model, const std::string& from, const std::vector<std::string>& folders);

}  // namespace tactus::dsl
