// A column: contiguous values of one field, aligned to 64 bytes and padded with zeros to a whole number of
// the widest vectors, so that a kernel may always read and write full vectors. What is in the padding must
// never influence a live lane.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace metamer {

inline constexpr size_t column_alignment = 64;  // bytes
inline constexpr size_t column_lanes = 16;      // rows are padded to a multiple of this

constexpr size_t padded_to_lanes(size_t n) { return (n + column_lanes - 1) / column_lanes * column_lanes; }

// Out of line: where it is inlined, GCC 12 warns of sizes that no call has.
[[gnu::noinline]] inline void zero_bytes(void* begin, void* end) {
  std::memset(begin, 0, static_cast<size_t>(static_cast<char*>(end) - static_cast<char*>(begin)));
}

template <class T>
class Column {
  static_assert(std::is_trivially_copyable_v<T>, "columns hold plain data");

 public:
  Column() = default;
  explicit Column(size_t size) { resize(size); }
  Column(const Column& other) { assign(other); }
  Column(Column&& other) noexcept { swap(other); }
  Column& operator=(const Column& other) {
    if (this != &other) assign(other);
    return *this;
  }
  Column& operator=(Column&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Column() { release(); }

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  size_t bytes() const { return capacity_ * sizeof(T); }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](size_t row) { return data_[row]; }
  const T& operator[](size_t row) const { return data_[row]; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  T& back() { return data_[size_ - 1]; }
  operator std::span<const T>() const { return {data_, size_}; }

  // New rows and all padding are zero.
  void resize(size_t size) {
    if (size > capacity_)
      grow(std::max(size, capacity_ * 2));
    else if (size < size_)
      zero_bytes(data_ + size, data_ + size_);
    size_ = size;
  }
  void reserve(size_t rows) {
    if (rows > capacity_) grow(rows);
  }
  void push_back(const T& value) {
    const T copy = value;  // may be one of our own rows, which growing would free
    if (size_ == capacity_) grow(std::max<size_t>(1, capacity_ * 2));
    data_[size_++] = copy;
  }
  void clear() { resize(0); }
  void swap(Column& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

 private:
  void assign(const Column& other) {
    clear();
    resize(other.size_);
    if (size_ > 0) std::memcpy(static_cast<void*>(data_), other.data_, size_ * sizeof(T));
  }
  void grow(size_t rows) {
    const size_t capacity = padded_to_lanes(rows);
    T* fresh = static_cast<T*>(::operator new (capacity * sizeof(T), std::align_val_t{column_alignment}));
    if (size_ > 0) std::memcpy(static_cast<void*>(fresh), data_, size_ * sizeof(T));
    zero_bytes(fresh + size_, fresh + capacity);
    release();
    data_ = fresh;
    capacity_ = capacity;
  }
  void release() {
    if (data_ != nullptr) ::operator delete (data_, std::align_val_t{column_alignment});
  }

  T* data_ = nullptr;
  size_t size_ = 0;
  size_t capacity_ = 0;  // a multiple of column_lanes
};

}  // namespace metamer
