-- Text after the file's closing bracket is ignored by default, and the strict importer reports it.
-- expect: lenient: true, 1 transform
-- expect: rsg/review/brackets.rsg:2:1: expected nothing after the body that begins here, found more
-- expect: strict: false, 0 transform
include "house.lua"
files() scene() physics() simulation()
for _, mode in ipairs{ "lenient", "strict" } do
  get("/sys/server/scene/rsg").strict = mode == "strict"
  local group = new("Transform", "/usr/scene/" .. mode)
  local ok, text = pcall(function() group:importScene("rsg/review/brackets.rsg") end)
  if not ok then print(text) end
  print(mode .. ": " .. tostring(ok) .. ", " .. #group:children() .. " transform")
end
