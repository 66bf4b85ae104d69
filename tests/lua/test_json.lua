-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"
local json = aib.json

return aib.test {
  ["numbers are written in the shortest form that reads back exactly"] = function(t)
    t:equal(json.number(0.1), "0.1")
    t:equal(json.number(1 / 3), "0.3333333333333333")
    t:equal(json.number(5e-324), "5e-324")
    t:equal(json.number(-2.0), "-2")
    t:equal(json.number(9007199254740993), "9007199254740993")
    t:equal(tonumber(json.number(0.1 + 0.2)), 0.1 + 0.2)
  end,

  ["a number that is not finite is an error"] = function(t)
    t:raises("not finite", json.encode, { x = 0 / 0 })
    t:raises("not finite", json.encode, { math.huge })
  end,

  ["keys are sorted and numbers may be keys"] = function(t)
    t:equal(json.encode { b = 1, a = 2, [0.05] = 3 }, '{"0.05": 3, "a": 2, "b": 1}')
  end,

  ["an empty table is an object unless it is called a list"] = function(t)
    t:equal(json.encode {}, "{}")
    t:equal(json.encode(json.list()), "[]")
  end,

  ["text is escaped"] = function(t)
    t:equal(json.encode 'a"b\\\n\1', '"a\\"b\\\\\\n\\u0001"')
  end,

  ["bytes that are no UTF-8 are replaced, and refused"] = function(t)
    t:equal(json.encode "a\xC6b\xFF", '"a\u{FFFD}b\u{FFFD}"')
    t:equal(json.encode "\xE2\x82", '"\u{FFFD}\u{FFFD}"')
    t:raises("r.json:2: UTF-8 expected, found byte 0xc6", json.decode, '["a",\n"\xC6b"]', "r.json")
  end,

  ["what is written is read back"] = function(t)
    local value = { name = "é\n", list = { 1, 2.5, -3e-9 }, deep = { yes = true, no = false }, empty = {} }
    t:equal(json.decode(json.encode(value)), value)
  end,

  ["null and surrogate pairs are read"] = function(t)
    t:check(json.decode("null") == json.null)
    t:equal(json.decode('"\\ud83d\\ude00 \\u00e9"'), "😀 é")
  end,

  ["what is no JSON is an error with the line and what was expected"] = function(t)
    t:raises("r.json:2: a name in quotes expected, found '}'", json.decode, '{"a": 1,\n}', "r.json")
    t:raises("r.json:1: ',' or ']' expected, found the end", json.decode, "[1", "r.json")
    t:raises("a value expected, found 'n'", json.decode, "nil")
    t:raises("a value expected", json.decode, "01")
    t:raises("json:1: a number below 1.8e308 expected, found -1e400", json.decode, "-1e400")
    t:raises("json:1: a number below 1.8e308 expected, found 1e400", json.decode, "[1e400\n]")
    t:raises("the end expected, found '2'", json.decode, "1 2")
    t:raises("json:1: the end of a string expected, found byte 0x0a", json.decode, '"a\nb"')
    t:raises("an escape sequence expected", json.decode, '"\\x"')
    t:raises("at most 200 levels", json.decode, ("["):rep(100000))
  end,
}
