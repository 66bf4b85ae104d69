// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <bind/kit.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace bind = aib::bind;
using bind::options;

/// A type with everything that the kit offers. Counts its live objects.
struct box {
  explicit box(std::size_t n) : values(n) { ++alive; }
  box(box&& other) noexcept : values(std::move(other.values)) { ++alive; }
  ~box() { --alive; }

  std::vector<int> values;
  static inline int alive = 0;
};

enum class shade { light, dark };

void bind_box(lua_State* state) {
  bind::type<box>(
      state, "box", [](const box& b) { return aib::message("box(", b.values.size(), " values)"); },
      [](const box& b) { return b.values.size() * sizeof(int); })
      .length([](const box& b) { return b.values.size(); })
      .element([](const box& b, std::size_t i) { return b.values.at(i) + 10 * i; })
      .field("first", [](const box& b) { return b.values.at(0); })
      .method("add", {"value"},
              [](box& b, int value) {
                b.values.push_back(value);
                return bind::self{};
              })
      .meta("__add", {"other"},
            [](const box& a, const box& b) { return box(a.values.size() + b.values.size()); });
}

void bind_functions(lua_State* state) {
  bind::module(state, "sample")
      .set("constant", 7)
      .function("box", {"n"}, [](std::size_t n) { return box(n); })
      .function("size", {"box"}, [](const box* b) { return b ? b->values.size() : 0; })
      .function("sum", {"values"},
                [](const std::vector<double>& values) {
                  double sum = 0;
                  for (const double v : values) sum += v;
                  return sum;
                })
      .function("point", {"p"}, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(2 * p); })
      .function("matrix", {"m"}, [](const Eigen::Matrix2d& m) { return m.transpose().eval(); })
      .function("options", {"options"},
                [](lua_State* l, options& o) {
                  bind::record r(l);
                  r.set("number", o.number("number", 1.5)).set("count", o.count("count", 2));
                  r.set("flag", o.flag("flag", false)).set("text", o.text("text", "none"));
                  r.set("tau", o.numbers("tau", {1, 2})).set("has_box", o.object<box>("box") != 0);
                  const auto shade = o.choice("shade", shade::light,
                                              {{"light", shade::light}, {"dark", shade::dark}});
                  r.set("dark", shade == shade::dark);
                  o.done();
                  return r;
                })
      .function("forgets", {"options"}, [](options& o) { o.flag("flag", false); })
      .function("several", {}, [] { return bind::results(1, std::string("two"), box(3)); })
      .function("keyed", {},
                [](lua_State* l) {
                  const std::vector<double> tau = {5, 0.05}, share = {0.25, 0.75};
                  return bind::keyed(l, tau, share);
                })
      .function("fail", {"kind"}, [](const std::string& kind) {
        if (kind == "io") throw aib::io_error("a.ply", "cannot open");
        if (kind == "format") throw aib::format_error("a.ply", aib::at_line{3}, "7 expected");
        if (kind == "undefined") throw aib::undefined_error("no values");
        if (kind == "stopped") throw aib::stopped_error("stopped");
        if (kind == "memory") throw std::bad_alloc();
        throw std::logic_error("a bug");
      });
}

/// Lua with the sample module as the global `m`.
class lua {
 public:
  lua() {
    session_.attach(state_.lua_state());
    state_.open_libraries();
    bind_box(state_.lua_state());
    bind_functions(state_.lua_state());
    state_["m"] = bind::module(state_.lua_state(), "sample").table();
  }

  /// Text of what an expression gives, or of the error that it raises.
  std::string operator()(const std::string& code) {
    const auto result =
        state_.safe_script("local r = (function() " + code + " end)() return tostring(r)",
                           sol::script_pass_on_error, "=script");
    if (result.valid()) return result.get<std::string>();
    const sol::error e = result;
    return std::string(e.what()).substr(0, std::string(e.what()).find("\nstack traceback"));
  }

  bind::session& session() { return session_; }

 private:
  bind::session session_;
  sol::state state_;
};

}  // namespace

TEST_CASE("an argument of another type is an error at the caller's line") {
  lua run;
  CHECK(run("\nm.box('x')") ==
        "script:2: aib.sample.box: argument 1 (n): integer >= 0 expected, found string 'x'");
  CHECK(run("m.box(-1)") ==
        "script:1: aib.sample.box: argument 1 (n): integer >= 0 expected, found number -1");
  CHECK(run("m.box(1.5)") ==
        "script:1: aib.sample.box: argument 1 (n): integer >= 0 expected, found number 1.5");
  CHECK(run("m.box()") ==
        "script:1: aib.sample.box: argument 1 (n): integer >= 0 expected, found nil");
  CHECK(run("m.size({})") ==
        "script:1: aib.sample.size: argument 1 (box): box or nil expected, found table");
  CHECK(run("m.sum{1, '2'}") ==
        "script:1: aib.sample.sum: argument 1 (values): list of numbers expected, found table");
  CHECK(run("m.point{1, 2}") ==
        "script:1: aib.sample.point: argument 1 (p): list of 3 numbers expected, found table");
  CHECK(run("m.size(nil, 2)") ==
        "script:1: aib.sample.size: at most 1 arguments expected, found 2");
}

TEST_CASE("arguments and results cross the border") {
  lua run;
  CHECK(run("return #m.box(3.0)") == "3");
  CHECK(run("return m.size()") == "0");
  CHECK(run("return m.size(m.box(4))") == "4");
  CHECK(run("return m.sum{1, 2.5}") == "3.5");
  CHECK(run("return m.point{1, 2, 3}[3]") == "6.0");
  CHECK(run("return m.matrix{{1, 2}, {3, 4}}[1][2]") == "3.0");
  CHECK(run("local a, b, c = m.several() return a .. b .. #c") == "1two3");
  CHECK(run("return m.constant") == "7");
}

TEST_CASE("thresholds are keys whether they are written as integers or floats") {
  lua run;
  CHECK(run("local k = m.keyed() return k[5] + k[5.0] + k[0.05]") == "1.25");
  CHECK(run("return m.keyed()") == "{[0.05] = 0.75, [5] = 0.25}");
}

TEST_CASE("options have defaults, types and choices") {
  lua run;
  CHECK(run("return m.options()") ==
        "{\n  count = 2,\n  dark = false,\n  flag = false,\n  has_box = false,\n  number = 1.5,\n"
        "  tau = {1.0, 2.0},\n  text = \"none\",\n}");
  CHECK(run("return m.options{shade = 'dark', box = m.box(1)}.dark") == "true");
  CHECK(run("return m.options{tau = 5}.tau[1]") == "5.0");
  CHECK(run("return m.options{number = 'x'}") ==
        "script:1: aib.sample.options: option 'number': number expected, found string 'x'");
  CHECK(run("return m.options{count = 0.5}") ==
        "script:1: aib.sample.options: option 'count': integer >= 0 expected, found number 0.5");
  CHECK(run("return m.options{flag = 1}") ==
        "script:1: aib.sample.options: option 'flag': boolean expected, found number 1");
  CHECK(run("return m.options{tau = {1, true}}") ==
        "script:1: aib.sample.options: option 'tau': list of numbers expected, found table");
  CHECK(run("return m.options{box = 3}") ==
        "script:1: aib.sample.options: option 'box': box expected, found number 3");
  CHECK(run("return m.options{shade = 'drak'}") ==
        "script:1: aib.sample.options: option 'shade': one of 'light', 'dark' expected, found "
        "'drak', did you mean 'dark'?");
}

TEST_CASE("an option that nobody knows is an error with a suggestion") {
  lua run;
  CHECK(run("m.options{numbr = 1}") ==
        "script:1: aib.sample.options: unknown option 'numbr', did you mean 'number'?");
  CHECK(run("m.options{threshold = 1}") ==
        "script:1: aib.sample.options: unknown option 'threshold' (known: number, count, flag, "
        "text, tau, box, shade)");
  CHECK(
      run("m.options{0.05}")
          .starts_with(
              "script:1: aib.sample.options: options are named, found one with the key number 1"));
  CHECK(run("m.options(3)") ==
        "script:1: aib.sample.options: argument 1 (options): table of options expected, found "
        "number 3");
  CHECK(run("m.forgets{}") == "script:1: aib.sample.forgets: the binding never calls done()");
}

TEST_CASE("a member that a type or module does not have is an error with a suggestion") {
  lua run;
  CHECK(run("return m.bux") == "script:1: aib.sample has no member 'bux', did you mean 'box'?");
  CHECK(run("return m.box(1).frist") ==
        "script:1: box has no member 'frist', did you mean 'first'?");
  CHECK(run("m.box(1).first = 2") == "script:1: box is read-only: cannot set string 'first'");
  CHECK(run("m.box(1).add(3, 4)") ==
        "script:1: box:add: the object before ':': box expected, found number 3");
  CHECK(run("m.box(1):add('x')") ==
        "script:1: box:add: argument 1 (value): integer expected, found string 'x'");
}

TEST_CASE("objects print themselves, have elements, and calls chain") {
  lua run;
  CHECK(run("return m.box(2)") == "box(2 values)");
  CHECK(run("return m.box(0):add(5):add(6)[2]") == "16");
  CHECK(run("local b = m.box(3) return tostring(b[0]) .. tostring(b[4])") == "nilnil");
  CHECK(run("local b, s = m.box(3), 0 for i, x in ipairs(b) do s = s + i * x end return s") ==
        "80");
  CHECK(run("local b, s = m.box(3), 0 for i, x in pairs(b) do s = s + i * x end return s") == "80");
  CHECK(run("return table.concat(m.box(3):to_table(), ' ')") == "0 10 20");
  CHECK(run("return #(m.box(1) + m.box(2))") == "3");
  CHECK(run("return getmetatable(m.box(1))") == "box");
}

TEST_CASE("errors carry their kind") {
  lua run;
  CHECK(run("m.fail('io')") == "script:1: a.ply: cannot open");
  CHECK(run("m.fail('format')") == "script:1: a.ply:3: 7 expected");
  CHECK(run("m.fail('memory')") == "script:1: not enough memory");
  CHECK(run("m.fail('bug')") == "script:1: a bug");
  using enum bind::error_kind;
  const auto kind = [&](const std::string& code) { return run.session().kind_of(run(code)); };
  CHECK(kind("m.fail('io')") == io);
  CHECK(kind("m.fail('format')") == format);
  CHECK(kind("m.fail('undefined')") == undefined);
  CHECK(kind("m.fail('stopped')") == stopped);
  CHECK(kind("m.fail('bug')") == internal);
  CHECK(kind("m.box()") == argument);
  CHECK(kind("error('of the script')") == script);
  CHECK(kind("local _, e = pcall(m.fail, 'io') error('context: ' .. e)") == io);
}

TEST_CASE("errors in a coroutine and through pcall keep their line") {
  lua run;
  CHECK(run("local ok, e = coroutine.resume(coroutine.create(function() m.box() end)) return e") ==
        "script:1: aib.sample.box: argument 1 (n): integer >= 0 expected, found nil");
  CHECK(run("local ok, e = pcall(m.box) return e").starts_with("script:1: aib.sample.box:"));
}

TEST_CASE("close frees an object at once, and it can be printed but not used") {
  lua run;
  const std::size_t held = run.session().held();
  CHECK(run("local kept do local b <close> = m.box(1000) kept = b end return kept") ==
        "box(closed)");
  CHECK(box::alive == 0);
  CHECK(run.session().held() == held);
  CHECK(run("local b = m.box(3) b:close() b:close() return b") == "box(closed)");
  CHECK(run("local b = m.box(3) b:close() return #b") == "script:1: box is closed");
}

TEST_CASE("nothing leaks, whether calls succeed or fail") {
  {
    lua run;
    for (int i = 0; i < 100; ++i) {
      run("return m.several()");
      run("m.options{box = m.box(1), nonsense = 1}");
      run("return m.box(1) + 3");
    }
  }
  CHECK(box::alive == 0);
}

TEST_CASE("the collector knows the real size of objects") {
  lua run;
  run("for i = 1, 100 do m.box(16 * 2^20) end");  // 64 MiB each
  CHECK(run.session().held() <= std::size_t{512} << 20);
}

TEST_CASE("a long call says how far it is, now and then, and cleans up; a short one says nothing") {
  double now = 0;
  std::string written;
  bind::meter meter([&] { return now; }, [&](std::string_view text) { written += text; });
  for (const double share : {0.1, 0.5, 1.0}) meter(share);
  CHECK(written.empty());
  for (const double share : {0.1, 0.25, 0.26, 0.27, 1.0, 0.5}) {
    meter(share);
    now += share < 0.26 ? 1 : 0.1;
  }
  CHECK(written == "\0337\033[K  25 %\0338\0337\033[K  26 %\0338\033[K");
}

TEST_CASE("a name near to none is answered with the list") {
  CHECK(bind::edit_distance("maxdeg", "max_deg") == 1);
  CHECK(bind::edit_distance("ab", "ba") == 1);
  CHECK(bind::suggestion("x", {}).empty());
  CHECK(bind::suggestion("alpha", {"beta", "gamma"}) == " (known: beta, gamma)");
}
