-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What must hold of statistics, of sensitivities and of what flights and sensors get wrong, whatever the numbers.
local aib = require "aib"
local sensitivity = require "aib.sensitivity"
local p = require "properties"

local near, list, random, mean, median, shuffled = p.near, p.list, p.random, p.mean, p.median, p.shuffled

return p.suite {
  ["stats: a summary is its definition, in any order"] = { 2000, function(t)
    local values = list(math.random(1, 30), function() return random(-5, 5) end)
    local s, m = aib.stats.summary(values), mean(values)
    near(t, s.mean, m)
    near(t, s.sse, mean(list(#values, function(i) return values[i] ^ 2 end)) * #values)
    near(t, s.rmse ^ 2, s.sse / #values)
    near(t, s.std ^ 2, mean(list(#values, function(i) return (values[i] - m) ^ 2 end)))
    near(t, aib.stats.summary(shuffled(values)).rmse, s.rmse)
    near(t, s.median, median(table.move(values, 1, #values, 1, {})))
    near(t, aib.stats.quantile(values, 0.5), s.median)
    local q = math.random()
    t:check(aib.stats.quantile(values, q) <= aib.stats.quantile(values, math.min(1, q + 0.1)), "rises")
  end },

  ["stats: merged moments are those of all, a bootstrap interval moves with its values"] = { 300, function(t)
    local a, b = aib.stats.moments(), aib.stats.moments()
    local values = list(math.random(2, 20), function() return random(-1, 1) end)
    for i, v in ipairs(values) do (i % 2 == 0 and a or b):add(v) end
    near(t, a:merge(b).mean, mean(values))
    local how = { block = 2, resamples = 50 }
    local plain, moved = aib.stats.bootstrap(values, how), aib.stats.bootstrap(list(#values, function(i)
      return values[i] + 4
    end), how)
    near(t, moved.low, plain.low + 4)
    near(t, moved.high, plain.high + 4)
    t:check(plain.low <= plain.high, "ordered")
  end },

  ["stats: quantiles are those of the sorted values, by each rule, infinite ones too"] = { 500, function(t)
    local values = list(math.random(1, 12), function()
      return math.random() < 0.1 and math.huge or math.random(-4, 4) / 2
    end)
    local s, q = p.sorted(values), math.random(0, 8) / 8
    local place = q * (#s - 1)
    local low, high = s[place // 1 + 1 | 0], s[math.ceil(place) + 1]
    local function check(rule, expected) t:equal(aib.stats.quantile(values, q, { rule = rule }), expected, rule) end
    check("lower", low)
    check("midpoint", low == high and low or (low + high) / 2)
    local linear = aib.stats.quantile(values, q)
    if high == math.huge then t:equal(linear, place % 1 == 0 and low or math.huge)
    else near(t, linear, low + (high - low) * (place % 1)) end
  end },

  ["stats: an interval scales with its values, turns round with them and closes on a constant"] = { 200, function(t)
    local values = list(math.random(2, 20), function() return random(-1, 1) end)
    local how = { block = math.random(1, 3), resamples = 60 }
    local b = aib.stats.bootstrap(values, how)
    local function of(change)
      return aib.stats.bootstrap(list(#values, function(i) return change(values[i]) end), how)
    end
    near(t, b.mean, mean(values))
    local three = of(function(v) return 3 * v end)
    near(t, three.high - three.low, 3 * (b.high - b.low))
    near(t, three.deviation, 3 * b.deviation)
    local negative = of(function(v) return -v end)
    near(t, negative.low, -b.high)
    local constant = of(function() return 0.25 end)
    t:equal({ constant.low, constant.high, constant.deviation }, { 0.25, 0.25, 0 })
    t:check(b.low >= math.min(table.unpack(values)) - 1e-12, "not below all")
    t:check(b.high <= math.max(table.unpack(values)) + 1e-12, "not above all")
  end },

  ["sensitivity: changes are means of paired differences, and turn round with the levels"] = { 100, function(t)
    local n = math.random(4, 20)
    local names = list(n, function(i) return ("f%03d"):format(i) end)
    local function level(condition)
      return { condition = condition, names = names, values = list(n, function() return random(0, 5) end) }
    end
    local low, middle, high = level "low", level "middle", level "high"
    local how = { resamples = 50 }
    local s = sensitivity.of({ low, middle, high }, how)
    near(t, s.change.mean, mean(high.values) - mean(low.values))
    near(t, s.slope.mean, (mean(high.values) - mean(low.values)) / 2)
    t:equal(s.n, n)
    near(t, s.within, math.max(math.abs(s.change.low), math.abs(s.change.high)))
    local back = sensitivity.of({ high, middle, low }, how)
    near(t, back.change.mean, -s.change.mean)
    local order = shuffled(list(n, function(i) return i end))
    local again = { condition = "low", names = list(n, function(i) return names[order[i]] end),
      values = list(n, function(i) return low.values[order[i]] end) }
    near(t, sensitivity.of({ again, middle, high }, how).change.mean, s.change.mean)
    local more = { condition = "low", names = { "other", table.unpack(names) } }
    more.values = { 99, table.unpack(low.values) }
    t:equal(sensitivity.of({ more, high }, how).n, n)
  end },

  ["survey: without errors a trajectory, a camera and an image stay what they are"] = { 60, function(t)
    local flight = p.walk(math.random(2, 9))
    near(t, aib.pose.ape(aib.survey.perturb(flight), flight, { relation = "full" }).max, 0)
    local bias = p.vector(2)
    local moved = aib.pose.ape(aib.survey.perturb(flight, { position_bias = bias }), flight)
    near(t, moved.min, p.norm(bias))
    near(t, moved.max, p.norm(bias))
    local turned = aib.survey.perturb(flight, { yaw_bias = 7 })
    near(t, aib.pose.ape(turned, flight, { relation = "angle_deg" }).min, 7)
    near(t, aib.pose.ape(turned, flight).max, 0)
    local camera = aib.survey.camera { width = 64, height = 48 }
    near(t, aib.pose.focal_error(aib.survey.perturb_cameras(camera, { "a", "b" }), { a = camera, b = camera }).mre, 0)
    local longer = aib.survey.perturb_cameras(camera, { "a" }, { focal_bias = 0.03 })
    near(t, aib.pose.focal_error(longer, { a = camera }).mre, 0.03)
  end },

  ["survey: what views see is a share, less of it the more must see it or the straighter"] = { 30, function(t)
    local wall = p.mesh({ { -2, 0, 0 }, { 2, 0, 0 }, { 2, 0, 3 }, { -2, 0, 3 } }, { { 1, 2, 3 }, { 1, 3, 4 } })
    local camera = aib.survey.camera { width = 64, height = 48 }
    local n = math.random(2, 6)
    local flight = aib.pose.trajectory(list(n, function()
      local rotation = { { 1, 0, 0 }, { 0, 0, 1 }, { 0, -1, 0 } }  -- looks along y
      return aib.math.pose { rotation = rotation, centre = { random(-2, 2), random(-6, -3), random(0, 3) } }
    end))
    local options = { samples = 300, columns = 8, rows = 6 }
    local m = aib.survey.measure(flight, camera, wall, options)
    local shares = { m.coverage[1], m.coverage[2], m.coverage[3], m.coverage[5], m.coverage[10] }
    local angles = { m.incidence[75], m.incidence[60], m.incidence[45], m.incidence[30], m.incidence[15] }
    for _, falling in ipairs { shares, angles } do
      for i, share in ipairs(falling) do t:check(share >= 0 and share <= (falling[i - 1] or 1), "falls") end
    end
    p.coarse(t, m.area, wall:area())
    near(t, m.unseen_area, m.area * (1 - m.coverage[1]))
    local others = aib.pose.trajectory(list(n + 1, function(i) return flight[math.min(i, n)] end))
    t:check(aib.survey.measure(others, camera, wall, options).coverage[2] >= m.coverage[2], "a view twice sees no less")
    local move = aib.math.sim3 { translation = p.vector(9) }
    p.coarse(t, aib.survey.measure(move * flight, camera, move * wall, options).area, m.area)
  end },
}
