# Flags that every target shares.  No NDEBUG anywhere: Simbody's headers change their class layout on it.
# No -march=native and no -ffast-math, and no contraction into fused multiply-add: golden runs must repeat.
set(CMAKE_CXX_FLAGS_RELEASE "-O3" CACHE STRING "" FORCE)
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g" CACHE STRING "" FORCE)
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g" CACHE STRING "" FORCE)

option(TACTUS_WERROR "Warnings are errors" OFF)
option(TACTUS_SANITIZE "Address and undefined-behaviour sanitizers" OFF)
option(TACTUS_FUZZ "The programs of tests/fuzz (clang alone has libFuzzer)" OFF)

add_library(tactus_flags INTERFACE)
set_target_properties(tactus_flags PROPERTIES EXPORT_NAME flags)
target_compile_features(tactus_flags INTERFACE cxx_std_20)
# -Wrestrict raises false alarms on temporaries of std::string in g++ 12 (GCC bug 105651).
target_compile_options(tactus_flags INTERFACE -ffp-contract=off
  "$<BUILD_INTERFACE:-Wall;-Wextra;$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>;$<$<BOOL:${TACTUS_WERROR}>:-Werror>>")
target_compile_definitions(tactus_flags INTERFACE $<$<CONFIG:Release>:EIGEN_NO_DEBUG>)
target_include_directories(tactus_flags INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tactus>)
if(TACTUS_SANITIZE)
  target_compile_options(tactus_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                -fno-omit-frame-pointer)
  # -Wmaybe-uninitialized raises false alarms on std::regex when g++ instruments (GCC bug 105562).
  target_compile_options(tactus_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(tactus_flags INTERFACE -fsanitize=address,undefined)
endif()
if(TACTUS_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "TACTUS_FUZZ needs clang: cmake --preset fuzz")
  endif()
  # Eigen adds offsets to the null pointer of empty matrices, and reads nothing there.
  target_compile_options(tactus_flags INTERFACE -fsanitize=fuzzer-no-link -fno-sanitize=pointer-overflow)
endif()
