#include "dsl/model_search.h"

#include <algorithm>
#include <filesystem>

namespace tactus::dsl {
namespace fs = std::filesystem;

ModelSearch findModel(const std::string& model, const std::string& from, const std::vector<std::string>& folders) {
  ModelSearch search;
  const std::string name = model.ends_with(".urdf") ? model : model + ".urdf";
  std::vector<fs::path> places{fs::path(from).parent_path()};
  for (const std::string& folder : folders) places.emplace_back(folder);
  if (fs::path(name).is_absolute()) places = {""};
  for (const fs::path& place : places) {
    const std::string file = (place / name).lexically_normal().string();
    std::error_code error;
    if (fs::is_regular_file(file, error)) {
      search.file = file;
      return search;
    }
    search.tried.push_back(file);
    for (const auto& entry : fs::directory_iterator(place.empty() ? fs::path(".") : place, error))
      if (entry.path().extension() == ".urdf")
        search.names.push_back(model.ends_with(".urdf") ? entry.path().filename().string()
                                                        : entry.path().stem().string());
  }
  std::sort(search.names.begin(), search.names.end());
  return search;
}

}  // namespace tactus::dsl
