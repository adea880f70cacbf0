on("perform", function(self, event)
  local number = event.data[2]
  if type(number) ~= "number" then return "expected (shout number), found '" .. tostring(number) .. "'" end
  print(string.format("shout: %d apples", number))
end)
