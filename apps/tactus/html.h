#pragma once

#include <string>

namespace tactus::app {

/// A whole page in the style of all our pages, with nothing from elsewhere; `title` is text, `body` HTML, `more_style`
/// CSS.
std::string htmlPage(const std::string& title, const std::string& body, const std::string& more_style = "");

}  // namespace tactus::app
