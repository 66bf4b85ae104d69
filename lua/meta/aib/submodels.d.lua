---@meta aib.submodels
error("Cannot require a meta file")

---COLMAP's and GLOMAP's sub-models of one scene.
---@class aib.submodels
local submodels = {}

---The models in a folder (0, 1, ..., or the folder itself): { name =, path =, trajectory =, cameras =, points = }.
---@param folder string
---@return table[]
function submodels.read(folder) end

---The model with most images; then that with more points, then the first. Never chosen by its score. nil for none.
---@param models table[]
---@return table|nil
function submodels.largest(models) end

return submodels
