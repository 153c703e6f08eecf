#include "dsl/codes.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>

namespace tactus::dsl {
namespace {

TEST(Codes, AreUniqueAndWellFormed) {
  std::set<std::string> ids, meanings;
  for (const Code& code : all_codes) {
    EXPECT_TRUE(std::regex_match(code.id, std::regex("[EW][0-9]{3}"))) << code.id;
    EXPECT_TRUE(ids.insert(code.id).second) << code.id;
    EXPECT_TRUE(meanings.insert(code.meaning).second) << code.meaning;
  }
}

}  // namespace
}  // namespace tactus::dsl
