-- Poses are matched by name, then every pair of cameras is compared: no alignment is needed.
local aib = require "aib"

local model = aib.io.read_trajectory "examples/data/methods/glomap/office_high/sparse"
local truth = aib.io.read_trajectory "examples/data/gt/office/poses"
local est, ref, counts = aib.pose.associate(model, truth, { by = "name" })
print(counts.n_matched .. " cameras")

local auc = aib.pose.auc(est, ref, { max_deg = 30 })
print(("AUC30 %.4f over %d pairs, %s convention"):format(auc.auc, auc.n_pairs, auc.convention))
local angles = aib.pose.relative_angles(est, ref, { tau = { 5, 15 } })
print(("within  5 deg: rotation %.3f, translation %.3f"):format(angles.rra[5], angles.rta[5]))
print(("within 15 deg: rotation %.3f, translation %.3f"):format(angles.rra[15], angles.rta[15]))
print(("registered: %.1f %%"):format(100 * aib.pose.registration_rate(model, truth).rate))
