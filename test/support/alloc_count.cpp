// SPDX-License-Identifier: BSD-3-Clause
#include "support/alloc_count.hpp"

#include <malloc.h>

#include <cerrno>
#include <cstddef>
#include <utility>

namespace {

using ergotic::test::AllocationScope;

// Only ever plain integers: the first heap call of a thread comes before any constructor.
thread_local int active_scopes = 0;
thread_local std::int64_t heap_calls = 0;
thread_local std::int64_t heap_bytes = 0;
thread_local AllocationScope::Tell tell_call = nullptr;

}  // namespace

#ifndef ERGOTIC_SANITIZED

namespace {
void count(const char* function) noexcept {
  heap_calls += active_scopes > 0 ? 1 : 0;
  if (const AllocationScope::Tell tell = std::exchange(tell_call, nullptr); tell != nullptr) {
    tell(function);  // nothing of what it does
    tell_call = tell;
  }
}
void* taken(void* block) noexcept {
  heap_bytes += active_scopes > 0 ? static_cast<std::int64_t>(malloc_usable_size(block)) : 0;
  return block;
}
void givenBack(void* block) noexcept {
  heap_bytes -= active_scopes > 0 ? static_cast<std::int64_t>(malloc_usable_size(block)) : 0;
}
}  // namespace

// glibc 2.36 has no malloc hooks; a program may define the functions over the names beneath them.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) noexcept {
  count("malloc");
  return taken(__libc_malloc(size));
}
void* calloc(std::size_t items, std::size_t size) noexcept {
  count("calloc");
  return taken(__libc_calloc(items, size));
}
void* realloc(void* old, std::size_t size) noexcept {
  count("realloc");
  givenBack(old);
  return taken(__libc_realloc(old, size));
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  count("memalign");
  return taken(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  count("aligned_alloc");
  return taken(__libc_memalign(alignment, size));
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  count("posix_memalign");
  *block = taken(__libc_memalign(alignment, size));
  return *block == nullptr ? ENOMEM : 0;
}
void free(void* block) noexcept {
  count("free");
  givenBack(block);
  __libc_free(block);
}
}

#endif

namespace ergotic::test {

AllocationScope::AllocationScope(Tell tell) noexcept {
  if (active_scopes++ == 0) {
    heap_calls = 0;
    heap_bytes = 0;
    tell_call = tell;
  }
}

AllocationScope::~AllocationScope() {
  if (--active_scopes == 0) {
    tell_call = nullptr;
  }
}

std::int64_t AllocationScope::calls() const noexcept {
  return heap_calls;
}

std::int64_t AllocationScope::bytes() const noexcept {
  return heap_bytes;
}

bool AllocationScope::isAvailable() noexcept {
#ifdef ERGOTIC_SANITIZED
  return false;
#else
  return true;
#endif
}

}  // namespace ergotic::test
