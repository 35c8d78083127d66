#include "tests/support/allocation_watch.h"

#include <cstdlib>
#include <new>

namespace {
std::size_t largest_allocation = 0;
}  // namespace

void* operator new(std::size_t size) {
  if (size > largest_allocation) largest_allocation = size;
  void* const memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
// std::stable_sort() allocates its buffer this way, and it must be freed by the matching operator.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  if (size > largest_allocation) largest_allocation = size;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace airdos {

void ResetLargestAllocation() { largest_allocation = 0; }
std::size_t LargestAllocation() { return largest_allocation; }

}  // namespace airdos
