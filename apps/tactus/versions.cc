#include "apps/tactus/versions.h"

#include <Eigen/Core>
#include <string>

#include "framework/runtime/version.h"

namespace tactus::app {

nlohmann::ordered_json versions() {
  const std::string eigen = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
                            std::to_string(EIGEN_MINOR_VERSION);
  return {{"tactus", TACTUS_VERSION},
          {"eigen", eigen},
          {"simbody", TACTUS_SIMBODY_VERSION},
          {"ipopt", TACTUS_IPOPT_VERSION},
          {"nlopt", TACTUS_NLOPT_VERSION},
          {"tinyxml2", TACTUS_TINYXML2_VERSION},
          {"urdfdom", TACTUS_URDFDOM_VERSION},
          {"compiler", "gcc " __VERSION__},
          {"build_type", TACTUS_BUILD_TYPE}};
}

}  // namespace tactus::app
