// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace aib::io {

/// A JSON value that knows its place in its file: whatever is missing or of the wrong kind is
/// refused with the file and the place ("frames[3].transform_matrix"). Borrows the value and path.
class json_node {
 public:
  json_node(const nlohmann::json& value, const std::filesystem::path& path, std::string place = {})
      : value_(&value), path_(&path), place_(std::move(place)) {}

  [[nodiscard]] bool is_object() const { return value_->is_object(); }
  [[nodiscard]] bool is_array() const { return value_->is_array(); }
  [[nodiscard]] bool is_number() const { return value_->is_number(); }

  /// The member of an object, nothing where there is none or it is null.
  [[nodiscard]] std::optional<json_node> find(const std::string& key) const {
    if (!value_->is_object()) fail(message("an object expected, found ", kind()));
    const auto member = value_->find(key);
    if (member == value_->end() || member->is_null()) return std::nullopt;
    return json_node(*member, *path_, place_.empty() ? key : message(place_, '.', key));
  }
  [[nodiscard]] json_node operator[](const std::string& key) const {
    if (auto member = find(key)) return std::move(*member);
    fail(message("'", key, "' expected, found none"));
  }

  /// Length and elements of an array.
  [[nodiscard]] std::size_t size() const {
    if (!value_->is_array()) fail(message("an array expected, found ", kind()));
    return value_->size();
  }
  [[nodiscard]] json_node operator[](std::size_t i) const {
    if (i >= size()) fail(message("at least ", i + 1, " elements expected, found ", size()));
    return {(*value_)[i], *path_, message(place_, '[', i, ']')};
  }

  /// Calls `visit(key, node)` for the members of an object, in the order of their keys.
  template <class Visit>
  void for_each_member(Visit&& visit) const {
    if (!value_->is_object()) fail(message("an object expected, found ", kind()));
    for (auto member = value_->begin(); member != value_->end(); ++member)
      visit(member.key(), json_node(*member, *path_, message(place_, '.', member.key())));
  }

  [[nodiscard]] double number() const {
    if (!value_->is_number()) fail(message("a number expected, found ", kind()));
    return value_->get<double>();
  }
  [[nodiscard]] std::string text() const {
    if (!value_->is_string()) fail(message("a text expected, found ", kind()));
    return value_->get<std::string>();
  }
  /// The number of a member, or `otherwise` where there is none.
  [[nodiscard]] double number(const std::string& key, double otherwise) const {
    const auto member = find(key);
    return member ? member->number() : otherwise;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(*path_, message(place_, place_.empty() ? "" : ": ", what));
  }

 private:
  [[nodiscard]] std::string_view kind() const { return value_->type_name(); }

  const nlohmann::json* value_;
  const std::filesystem::path* path_;
  std::string place_;
};

/// The content of a JSON file. Throws format_error where it is not JSON.
///
/// keep   called as keep(key) for each member of an object; where it says no the member's value is
///        dropped as it is read, so that large parts need no memory
template <class Keep>
[[nodiscard]] nlohmann::json read_json(const std::filesystem::path& path, Keep&& keep) {
  using json = nlohmann::json;
  const std::string text = read_file(path);
  const auto callback = [&](int, json::parse_event_t event, json& parsed) {
    return event != json::parse_event_t::key || keep(parsed.get_ref<const std::string&>());
  };
  try {
    return json::parse(text, callback);
  } catch (const json::parse_error& e) {
    const std::string_view what = e.what();
    const std::size_t end_of_id = what.find("] ");
    throw format_error(
        path, at_byte{e.byte},
        message("json: ", end_of_id == std::string_view::npos ? what : what.substr(end_of_id + 2)));
  } catch (const json::exception& e) {
    throw format_error(path, message("json: ", e.what()));
  }
}

[[nodiscard]] inline nlohmann::json read_json(const std::filesystem::path& path) {
  return read_json(path, [](const std::string&) { return true; });
}

}  // namespace aib::io
