-- A protocol: typed inputs, a report, and --help, --json, --csv, --markdown, --latex for nothing.
local aib = require "aib"

return aib.protocol {
  name = "focal length",
  inputs = {
    model = { kind = "path", help = "a model of any format", default = "examples/data/methods/glomap/crane/sparse" },
    truth = { kind = "path", help = "the true cameras", default = "examples/data/gt/crane/poses" },
  },
  run = function(input, report)
    local cameras = aib.io.read_cameras(input.model)
    local focal = aib.pose.focal_error(cameras, aib.io.read_cameras(input.truth))
    report:add("focal length, mean relative error", 100 * focal.mre, { unit = "%", better = "lower", n = focal.n })
  end,
}
