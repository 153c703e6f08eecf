#include "conformance/allocation_count.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace {

std::atomic<long> count{0};

}  // namespace

#ifdef __SANITIZE_ADDRESS__

// Of sanitizer/allocator_interface.h, which g++ does not bring along.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*, size_t),
                                                         void (*free_hook)(const volatile void*));

namespace {

const int installed = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, size_t) { ++count; }, [](const volatile void*) {});

}  // namespace

#else

// operator new comes here as well.
extern "C" {

void* __libc_malloc(size_t size);
void* __libc_calloc(size_t number, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) {
  ++count;
  return __libc_malloc(size);
}

void* calloc(size_t number, size_t size) {
  ++count;
  return __libc_calloc(number, size);
}

void* realloc(void* memory, size_t size) {
  ++count;
  return __libc_realloc(memory, size);
}

void* aligned_alloc(size_t alignment, size_t size) {
  ++count;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, size_t alignment, size_t size) {
  ++count;
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}

}  // extern "C"

#endif

namespace tactus::conformance {

long allocationCount() {
#ifdef __SANITIZE_ADDRESS__
  static_cast<void>(installed);
#endif
  return count;
}

}  // namespace tactus::conformance
