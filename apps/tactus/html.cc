#include "apps/tactus/html.h"

#include "apps/tactus/plot.h"

namespace tactus::app {
namespace {

constexpr const char* style = R"(
body { font-family: system-ui, 'DejaVu Sans', 'Liberation Sans', sans-serif; color: #222; background: #f6f6f3;
       margin: 0; }
main { max-width: 1140px; margin: 0 auto; padding: 24px; }
h1 { font-size: 24px; font-weight: 650; margin: 8px 0 20px; }
section { background: #fff; border: 1px solid #e2e2dc; border-radius: 8px; padding: 16px; margin-bottom: 20px; }
.columns { display: flex; gap: 40px; flex-wrap: wrap; }
svg { display: block; width: 100%; height: auto; }
table { border-collapse: collapse; font-size: 14px; }
th, td { text-align: left; padding: 4px 14px 4px 0; border-bottom: 1px solid #eeeeea; }
h2 { font-size: 17px; font-weight: 650; margin: 14px 0 8px; }
td.task { padding-left: 18px; } li { font-size: 14px; margin: 3px 0; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
.met { color: #1a7f37; } .missed { color: #c0392b; font-weight: 600; }
)";

}  // namespace

std::string htmlPage(const std::string& title, const std::string& body, const std::string& more_style) {
  return "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>" + escaped(title) + "</title><style>" +
         style + more_style + "</style></head><body><main>\n<h1>" + escaped(title) + "</h1>\n" + body + "</main></body></html>\n";
}

}  // namespace tactus::app
