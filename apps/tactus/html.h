#pragma once

#include <string>

namespace tactus::app {

/// A whole page in the style of all our pages, with nothing from elsewhere; `title` is text, `body` HTML.
std::string htmlPage(const std::string& title, const std::string& body);

}  // namespace tactus::app
