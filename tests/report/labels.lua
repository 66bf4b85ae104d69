-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report whose every label tries to break out of its place.
local aib = require "aib"

local nasty <const> = "</script><script>window.broken = 1</script><img src=x onerror=\"window.broken = 2\">'&\u{2028}"

return aib.protocol {
  name = "labels", title = nasty, cite = nasty,
  run = function(_, report)
    for i, method in ipairs { nasty, ("m"):rep(200), ("long name "):rep(20), "C" } do
      for k, scene in ipairs { nasty, ("s"):rep(200) } do
        local cell = report:within { scene = scene, method = method }
        cell:add(nasty, i * k, { unit = nasty, better = "lower", convention = nasty, options = { [nasty] = nasty } })
        cell:note(nasty)
        cell:curve { title = nasty, label = nasty, x = { label = nasty }, y = { label = nasty }, text = nasty,
          at = { 1, 2, 3 }, values = { i, 2, k } }
        cell:timeline { title = "T" .. nasty, y = { label = nasty }, frames = { nasty, "b" }, values = { 1, 2 } }
        cell:interval { title = nasty, label = nasty, value = 1, low = 0, high = 2 }
        cell:cloud { role = nasty, cloud = aib.cloud.from_points { { 0, 0, 0 }, { 1, 1, 1 } }, values = { 0, 1 },
          label = nasty, unit = nasty }
      end
    end
    report:convention(nasty, nasty)
    report:source(nasty, { bytes = 1, sha256 = nasty })
  end,
}
