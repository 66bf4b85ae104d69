// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/large_pages.hpp>

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

namespace aib::search {

/// An array whose elements begin undefined, in large pages where the system has them.
template <class T>
class buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  buffer() = default;
  explicit buffer(std::size_t size) : data_(allocate(size)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return data_.get(); }
  [[nodiscard]] const T* data() const { return data_.get(); }
  [[nodiscard]] T& operator[](std::size_t i) { return data_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return data_[i]; }
  [[nodiscard]] std::span<const T> span() const { return {data(), size_}; }

 private:
  static std::size_t alignment(std::size_t size) {
    return size * sizeof(T) >= 2 * large_page ? large_page : 64;
  }

  struct release {
    std::size_t alignment = 64;
    void operator()(T* p) const { ::operator delete (p, std::align_val_t{alignment}); }
  };

  static std::unique_ptr<T[], release> allocate(std::size_t size) {
    const std::size_t bytes = size * sizeof(T);
    const std::size_t align = alignment(size);
    void* memory = ::operator new (bytes, std::align_val_t{align});
    advise_large_pages(memory, bytes);
    return {static_cast<T*>(memory), release{align}};
  }

  std::unique_ptr<T[], release> data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace aib::search
