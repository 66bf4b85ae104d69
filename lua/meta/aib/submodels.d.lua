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

---@class aib.Registration
---@field rate number  # share
---@field n_registered integer
---@field n_total integer
---@field missing string[]

---How many frames of a truth the models register: the largest alone, each, and all together.
---@param models table[]  # each with a `trajectory`: of read above or aib.io.read_opensfm_components
---@param truth aib.Trajectory
---@param options? { ignore_case?: boolean, ignore_extension?: boolean, ignore_folder?: boolean }
---@return { largest: aib.Registration|nil, each: aib.Registration[], merged: aib.Registration }
function submodels.registration(models, truth, options) end

return submodels
