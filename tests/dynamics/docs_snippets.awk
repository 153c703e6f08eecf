# Makes one test of all C++ blocks of a page: includes first, then the blocks in their order.
/^```cpp$/ { inside = 1; next }
/^```$/ { inside = 0; next }
inside && /^#include/ { includes = includes $0 "\n"; next }
inside { body = body "  " $0 "\n" }
END {
  print "#include <gtest/gtest.h>\n\n#include <cmath>\n#include <numbers>\n\n" includes
  print "#undef assert\n#define assert EXPECT_TRUE\n\nTEST(Docs, " name ") {\n" body "}"
}
