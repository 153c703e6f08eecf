#include "apps/tactus/touched_cloud.h"

#include <algorithm>

#include "framework/runtime/percentile.h"

namespace tactus::app {

TouchedCloud touchedCloud(const runtime::CsvTable& touched) {
  TouchedCloud cloud;
  cloud.x = touched.numbers("x");
  cloud.y = touched.numbers("y");
  cloud.z = touched.numbers("z");
  if (cloud.z.empty()) return cloud;
  cloud.plane = runtime::percentile(cloud.z, 0.02);
  for (const double z : cloud.z) cloud.height_mm.push_back((z - cloud.plane) * 1000);
  cloud.height_max = std::max(1.0, runtime::percentile(cloud.height_mm, 0.999));
  return cloud;
}

}  // namespace tactus::app
