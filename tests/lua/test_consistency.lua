-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"
local check = aib.consistency.check

return aib.test {
  ["numbers of one pass over points stand together"] = function(t)
    t:equal(check {
      ["cloud.accuracy"] = 0.1, ["cloud.completeness"] = 0.3, ["cloud.chamfer"] = 0.4, ["cloud.chamfer_mean"] = 0.2,
      ["cloud.f1_distance"] = 0.15,
    }, {})
  end,

  ["a harmonic mean above the arithmetic one is impossible"] = function(t)
    t:equal(check { ["cloud.f1_distance"] = 0.617, ["cloud.chamfer"] = 0.537 }, {
      "cloud.f1_distance = 0.617 is above half of cloud.chamfer = 0.537: "
        .. "a harmonic mean never exceeds the arithmetic mean",
    })
  end,

  ["equal distances are the limit, not beyond it"] = function(t)
    t:equal(check { ["cloud.f1_distance"] = 0.25, ["cloud.chamfer"] = 0.5 }, {})
    t:equal(#check { ["cloud.f1_distance"] = 0.2501, ["cloud.chamfer"] = 0.5 }, 1)
  end,

  ["rounded numbers of a printed table get the benefit of the rounding"] = function(t)
    t:equal(check({ ["cloud.f1_distance"] = 0.251, ["cloud.chamfer"] = 0.501 }, 0.0005), {})
    t:equal(#check({ ["cloud.f1_distance"] = 0.252, ["cloud.chamfer"] = 0.501 }, 0.0005), 1)
  end,

  ["a sum that is not one is impossible"] = function(t)
    t:contains(check({ ["cloud.accuracy"] = 0.1, ["cloud.completeness"] = 0.3, ["cloud.chamfer"] = 0.5 })[1],
      "is not the sum of")
  end,

  ["wider thresholds count more, joint recall less, shares at most all"] = function(t)
    t:equal(#check { ["depth.delta1"] = 0.9, ["depth.delta2"] = 0.8 }, 1)
    t:equal(#check { ["pose.rra5"] = 0.9, ["pose.rra15"] = 0.8 }, 1)
    t:equal(#check { ["pose.auc30_joint"] = 0.9, ["pose.auc30"] = 0.8 }, 1)
    t:equal(#check { ["depth.coverage"] = 1.1 }, 1)
    t:equal(#check { ["pose.auc30"] = -0.1 }, 1)
  end,

  ["the root of a mean is not below the mean of roots"] = function(t)
    t:equal(check { ["depth.si_log_rmse"] = 0.3, ["depth.srmse"] = 0.09 }, {})
    t:equal(#check { ["depth.si_log_rmse"] = 0.31, ["depth.srmse"] = 0.09 }, 1)
  end,

  ["an accuracy below what samples allow is told"] = function(t)
    local found, empty = check({ ["cloud.accuracy"] = 0.001, ["cloud.sampling_floor"] = 0.01 })
    t:equal(found, {})
    t:contains(empty[1], "lies below")
  end,

  ["a report is checked group by group"] = function(t)
    local report = aib.report.new { name = "x", version = "0" }
    report:within({ method = "A" }):add("cloud.f1_distance", 0.6)
    report:within({ method = "B" }):add("cloud.chamfer", 0.5)
    t:equal(aib.consistency.check_report(report), 0)
    report:within({ method = "A" }):add("cloud.chamfer", 0.5)
    t:equal(aib.consistency.check_report(report), 1)
    t:contains(report:note_lines()[1], "A: impossible: cloud.f1_distance = 0.6")
  end,
}
