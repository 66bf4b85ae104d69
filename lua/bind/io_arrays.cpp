// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/distances.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/pose_arrays.hpp>
#include <aib/io/trajectory.hpp>

#include "kit.hpp"
#include "stats.hpp"

#ifdef AIB_WITH_NPZ
#include <aib/io/npz.hpp>
#endif

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aib::bind {

namespace {

namespace fs = std::filesystem;

std::string print_array(const io::array& a) {
  return message("array(", name(a.type), " ", io::text_of_shape(a.shape), ")");
}

std::size_t bytes_of_array(const io::array& a) { return a.bytes.size(); }

bool is_npz(const fs::path& path) { return path.extension() == ".npz"; }

#ifdef AIB_WITH_NPZ
io::array read_member(const fs::path& path, const std::string& key, const io::limits& limits) {
  const io::npz_file file(path, limits);
  const std::vector<std::string> names = file.names();
  return file.read(key.empty() && names.size() == 1 ? names.front() : key);
}
std::vector<std::string> member_names(const fs::path& path) {
  return is_npz(path) ? io::npz_file(path).names() : std::vector<std::string>();
}
#else
io::array read_member(const fs::path& path, const std::string&, const io::limits&) {
  io::detail::needs_library(path, "NPZ", "zlib");
}
std::vector<std::string> member_names(const fs::path& path) {
  io::detail::needs_library(path, "NPZ", "zlib");
}
#endif

/// Numbers of nested lists in C order.
class nested_numbers {
 public:
  explicit nested_numbers(const sol::table& list) { add(list, 0); }
  [[nodiscard]] io::array array() const { return io::make_array<double>(shape_, numbers_); }

 private:
  static constexpr std::size_t most_axes = 32;  // NumPy's own limit

  [[noreturn]] static void refuse() {
    throw argument_error("aib.io.array: numbers, or lists of numbers of one size, expected");
  }

  void add(const sol::table& list, std::size_t axis) {
    if (axis == most_axes) refuse();  // a list that contains itself has no end
    const std::size_t n = list.size();
    if (shape_.size() == axis && numbers_.empty()) shape_.push_back(n);
    if (shape_.size() <= axis || shape_[axis] != n) refuse();
    if (const auto numbers = read_if<std::vector<double>>(list)) {
      if (shape_.size() != axis + 1) refuse();
      numbers_.insert(numbers_.end(), numbers->begin(), numbers->end());
      return;
    }
    for (std::size_t i = 1; i <= n; ++i) {
      const auto part = list.get<sol::object>(i);
      if (part.get_type() != sol::type::table) refuse();
      add(part, axis + 1);
    }
  }

  std::vector<std::size_t> shape_;
  std::vector<double> numbers_;
};

io::array array_of(const cloud::cloud& c) {
  std::vector<double> numbers;
  numbers.reserve(3 * c.size());
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Eigen::Vector3d p = c.position(i);
    numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
  }
  return io::make_array<double>({c.size(), 3}, numbers);
}

io::array array_of(const depth::depth_map& map) {
  const auto& v = map.values;
  const std::span<const float> pixels(v.data(), v.width() * v.height());
  return io::make_array<float>({v.height(), v.width()}, pixels);
}

/// The object of a bound type, nullptr where the value is something else.
template <class T>
const T* bound(const sol::object& object) {
  lua_State* state = object.lua_state();
  const auto popper = sol::stack::push_pop(object);
  const int top = lua_gettop(state);
  return value<T>::is(state, top) ? &value<T>::get(state, top) : nullptr;
}

io::array array_of(const sol::object& object) {
  if (const auto* a = bound<io::array>(object)) return *a;
  if (const auto* d = bound<cloud::distances>(object))
    return io::make_array<float>({d->size()}, d->values());
  if (const auto* c = bound<cloud::cloud>(object)) return array_of(*c);
  if (const auto* m = bound<depth::depth_map>(object)) return array_of(*m);
  if (const auto* t = bound<pose::trajectory>(object)) return io::array_of_poses(*t);
  if (object.get_type() == sol::type::table) return nested_numbers(object).array();
  throw argument_error(
      "aib.io.array: array, distances, cloud, depth_map, trajectory or list of numbers expected");
}

record summary_of(lua_State* state, const io::array& a) {
  stats::moments finite;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isfinite(a[i])) finite.add(a[i]);
  }
  record r(state);
  r.set("shape", a.shape).set("dtype", name(a.type)).set("n", a.size());
  return set_moments(r.set("n_finite", finite.count()), finite);
}

void bind_array(lua_State* state) {
  type<io::array>(state, "array", print_array, bytes_of_array)
      .length([](const io::array& a) { return a.size(); })
      .element([](const io::array& a, std::size_t i) { return a[i]; })
      .field("shape", [](const io::array& a) { return a.shape; })
      .field("dtype", [](const io::array& a) { return name(a.type); })
      .method("summary", {}, [](lua_State* l, const io::array& a) { return summary_of(l, a); })
      .method("at", {"index"}, [](const io::array& a, std::size_t index) {
        if (index == 0) throw argument_error("array:at: indices begin at 1");
        return a.at(index - 1);
      });
}

}  // namespace

void bind_io_arrays(lua_State* state) {
  bind_array(state);
  module(state, "io")
      .function("read_array", {"path", "options"},
                [](const fs::path& path, options& o) {
                  const std::string key = o.text("key", "");
                  io::limits limits;
                  limits.max_ratio = o.number("max_ratio", limits.max_ratio);
                  limits.max_bytes = o.count("max_bytes", limits.max_bytes);
                  o.done();
                  return is_npz(path) ? read_member(path, key, limits) : io::read_npy(path);
                })
      .function("array_names", {"path"}, [](const fs::path& path) { return member_names(path); })
      .function("array", {"value"}, [](const sol::object& value) { return array_of(value); })
      .function("write_array", {"path", "value"},
                [](const fs::path& path, const sol::object& value) {
                  io::write_npy(path, array_of(value));
                });
}

}  // namespace aib::bind
