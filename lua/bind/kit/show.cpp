// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "show.hpp"

#include <aib/core/message.hpp>

#include "value.hpp"
#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

constexpr lua_Integer longest_list = 20;
constexpr std::size_t most_names = 100;
constexpr int deepest = 4;

std::string text_of(lua_State* state, int index) {
  std::size_t size = 0;
  const char* text = luaL_tolstring(state, index, &size);
  std::string out(text, size);
  lua_pop(state, 1);
  return out;
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    c == '\n' ? out += "\\n" : out += c;
  }
  return out + '"';
}

bool is_name(std::string_view text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !text.empty() && letter(text[0]) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || digit(c); });
}

/// Shows one value and what it holds.
class shower {
 public:
  shower(lua_State* state, std::size_t width) : state_(state), width_(width) {}

  std::string value_at(int index, std::size_t indent) {
    if (lua_type(state_, index) == LUA_TSTRING) return in_quotes(text_of(state_, index));
    if (!lua_istable(state_, index) || prints_itself(index)) return text_of(state_, index);
    const void* table = lua_topointer(state_, index);
    if (std::ranges::count(open_, table) > 0) return "{...}";
    if (open_.size() == deepest) return "{...}";
    luaL_checkstack(state_, 8, "the table is too deep");
    open_.push_back(table);
    std::string text = joined(parts_of(lua_absindex(state_, index), indent + 2), indent);
    open_.pop_back();
    return text;
  }

 private:
  /// The table of a record prints itself through here; asking it would never end.
  bool prints_itself(int index) {
    if (luaL_getmetafield(state_, index, "__tostring") == LUA_TNIL) return false;
    lua_pop(state_, 1);
    const bool is_record = luaL_getmetafield(state_, index, "__record") != LUA_TNIL;
    if (is_record) lua_pop(state_, 1);
    return !is_record;
  }

  std::vector<std::string> parts_of(int table, std::size_t indent) {
    std::vector<std::string> parts;
    const auto n = static_cast<lua_Integer>(lua_rawlen(state_, table));
    for (lua_Integer i = 1; i <= std::min(n, longest_list); ++i) {
      lua_rawgeti(state_, table, i);
      parts.push_back(value_at(lua_gettop(state_), indent));
      lua_pop(state_, 1);
    }
    if (n > longest_list) parts.push_back(message("... ", n - longest_list, " more"));
    for (std::string& field : fields_of(table, n, indent)) parts.push_back(std::move(field));
    return parts;
  }

  /// What is not in the list: numbers ascending, then names, then the rest.
  std::vector<std::string> fields_of(int table, lua_Integer n, std::size_t indent) {
    struct field {
      int rank;
      double number;
      std::string key, text;
      auto operator<=>(const field&) const = default;
    };
    std::vector<field> fields;
    std::size_t left_out = 0;
    lua_pushnil(state_);
    for (; lua_next(state_, table); lua_pop(state_, 1)) {
      if (lua_isinteger(state_, -2) && lua_tointeger(state_, -2) >= 1 &&
          lua_tointeger(state_, -2) <= n)
        continue;
      if (fields.size() == most_names) {
        ++left_out;
        continue;
      }
      const int key = lua_gettop(state_) - 1;
      const bool is_number = lua_type(state_, key) == LUA_TNUMBER;
      const bool is_string = lua_type(state_, key) == LUA_TSTRING;
      std::string name = text_of(state_, key);
      if (!is_string || !is_name(name)) name = "[" + (is_string ? in_quotes(name) : name) + "]";
      fields.push_back({is_number   ? 0
                        : is_string ? 1
                                    : 2,
                        is_number ? lua_tonumber(state_, key) : 0, std::move(name),
                        value_at(key + 1, indent)});
    }
    std::sort(fields.begin(), fields.end());
    std::vector<std::string> parts;
    for (const field& f : fields) parts.push_back(f.key + " = " + f.text);
    if (left_out > 0) parts.push_back(message("... ", left_out, " more"));
    return parts;
  }

  std::string joined(const std::vector<std::string>& parts, std::size_t indent) const {
    std::string line;
    for (const std::string& part : parts) line += (line.empty() ? "" : ", ") + part;
    if (indent + line.size() + 2 <= width_ && line.find('\n') == line.npos) return "{" + line + "}";
    const std::string margin(indent, ' ');
    std::string lines = "{\n";
    for (const std::string& part : parts) lines += margin + "  " + part + ",\n";
    return lines + margin + "}";
  }

  lua_State* state_;
  std::size_t width_;
  std::vector<const void*> open_ = {};
};

}  // namespace

std::string show(lua_State* state, int index, std::size_t width) {
  return shower(state, width).value_at(index, 0);
}

}  // namespace aib::bind
