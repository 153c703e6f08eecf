#include "tests/witness/mujoco/load.h"

#include <cstring>
#include <stdexcept>
#include <string>

#include "tests/witness/mujoco/mjcf.h"

namespace tactus::witness {

MujocoModel loadMujoco(const description::Robot& robot, const Eigen::Vector3d& gravity_W) {
  const std::string mjcf = writeMjcf(robot, gravity_W);
  const auto files = std::make_unique<mjVFS>();                    // megabytes: not on the stack
  mj_defaultVFS(files.get());
  const char* name = "robot.xml";
  mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(mjcf.size()));
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  char error[1000] = "";
  MujocoModel model(mj_loadXML(name, files.get(), error, sizeof error));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error("MuJoCo refuses '" + robot.name + "': " + error);
  return model;
}

}  // namespace tactus::witness
