-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Result files that are none, shards that do not belong together, and what a failing check says.
local aib = require "aib"
local results = require "aib.results"

--- What reading a result file of this text says, without the path.
local function said_of(t, text)
  local path <const> = os.tmpname()
  aib.system.write_text(path, text)
  local ok, message = pcall(results.read, path)
  os.remove(path)
  t:check(not ok, text)
  t:equal(aib.error_kind(message), "format")
  return (message:gsub("^.-: ", "", 1))
end

local function shard(n_parts, ...)
  return {
    path = "shard.json",
    result = {
      aib = { version = "1" }, protocol = { name = "p" }, inputs = { "same" },
      shard = { count = 2, n_parts = n_parts, parts = { ... } },
    },
  }
end

--- What a failing check says, without its place.
local function failure_of(t, check)
  local ok, message = pcall(check, getmetatable(t).__index)
  t:check(not ok)
  return (message:gsub("^[^:]+:%d+: ", ""))
end

return aib.test {
  ["a file that holds no results is refused"] = function(t)
    for _, text in ipairs { "3", "{}", '{"aib": 1, "records": []}', '{"aib": {"format": 1}}' } do
      t:equal(said_of(t, text), "results of aib expected (an object with aib and records)")
    end
    t:equal(said_of(t, '{"aib": {"format": 7}, "records": []}'), "results of format 1 expected, found 7")
    t:equal(said_of(t, '{"aib": {}, "records": []}'), "results of format 1 expected, found none")
  end,

  ["results that break their schema are refused"] = function(t)
    local function said_of_records(records, more)
      return said_of(t, ('{"aib": {"format": 1, "version": "1"}, "protocol": {"name": "p"}, "records": [%s]%s}'):format(
        records, more or ""))
    end
    t:equal(said_of_records '{"name": "a", "value": 1}, {"name": 1, "value": 1}',
      "records[2].name: string expected, found 1")
    t:equal(said_of_records '{"name": "a", "value": "1"}', "records[1].value: number or null expected, found '1'")
    t:equal(said_of_records '{"name": "a"}', "records[1]: value is missing")
    t:equal(said_of_records '{"name": "a", "value": 1, "group": {"scene": ["x"]}}',
      "records[1].group.scene: string expected, found an array")
    t:equal(said_of_records '{"name": "a", "value": 1, "better": "more"}',
      "records[1].better: lower or higher expected, found 'more'")
    t:equal(said_of_records '{"name": "a", "value": 1, "units": "m"}',
      "records[1]: unknown field 'units', did you mean 'unit'?")
    t:equal(said_of_records("", ', "sources": {"a": {"bytes": -1, "sha256": "00"}}'),
      "sources.a.bytes: 0 or more expected, found -1")
    t:equal(said_of_records("", ', "sources": {"a": {"bytes": 1, "sha256": "x"}}'),
      "sources.a.sha256: 64 hexadecimal digits expected, found 'x'")
    t:equal(said_of_records("", ', "frames": [{"metric": "a", "group": {}, "names": ["b"], "values": []}]'),
      "frames[1]: as many values as names expected, found 0 and 1")
  end,

  ["the place of a shard is INDEX/COUNT"] = function(t)
    t:equal({ aib.units.shard_of "3/16" }, { 3, 16 })
    t:equal({ aib.units.shard_of(nil) }, { 1, 1 })
    for _, text in ipairs { "3", "0/4", "5/4", "1/2/3", "-1/4" } do
      t:raises(("--shard: INDEX/COUNT expected, as 3/16, found '%s'"):format(text), aib.units.shard_of, text)
    end
  end,

  ["shards that do not make one run are refused"] = function(t)
    local a, b = { place = 1, name = "a" }, { place = 2, name = "b" }
    t:equal(#aib.units.joined { shard(2, a), shard(2, b) }, 2)
    t:raises("shard.json: part 1, a, comes twice", aib.units.joined, { shard(2, a), shard(2, a) })
    t:raises("shard 2/2 is missing", aib.units.joined, { shard(2, a) })
    t:raises("shard.json: a shard of the same run as shard.json expected", aib.units.joined,
      { shard(2, a), shard(3, b) })
    local none = shard(2, b)
    none.result.shard = nil
    t:raises("shard.json: a shard expected, made by --shard INDEX/COUNT", aib.units.joined, { shard(2, a), none })
  end,

  ["a check that fails says what was expected and what was found"] = function(t)
    t:equal(failure_of(t, function(c) c:check(false, "it") end), "it: expected to hold, found false")
    t:equal(failure_of(t, function(c) c:equal({ 1, x = "2" }, { 1, x = 2 }) end),
      'expected {[1] = 1, x = 2}, found {[1] = 1, x = "2"}')
    t:equal(failure_of(t, function(c) c:near("a", 1, 0) end), 'expected a number, found "a"')
    t:contains(failure_of(t, function(c) c:near(0 / 0, 1, 0.5) end), "expected 1 within 0.5, found")
    t:equal(failure_of(t, function(c) c:contains("abc", "d") end), 'expected a text with "d", found "abc"')
    t:equal(failure_of(t, function(c) c:raises("x", function() end) end), 'expected an error with "x", found none')
    t:raises("aib.test: a table of cases expected, found nil", aib.test, nil)
    t:raises("aib.test: functions by name expected, found 1 = function", aib.test, { function() end })
    t:raises("aib.test: functions by name expected, found a = number", aib.test, { a = 1 })
  end,
}
