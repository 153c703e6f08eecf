#include "framework/runtime/plugin_api.h"
#include "plugins/grasp/grasp_quality.h"

TACTUS_PLUGIN("grasp", TACTUS_VERSION, "unspecified", tactus::plugins::GraspQualityMeasure::registerIn)
