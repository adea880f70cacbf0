on("act", function(self, event)
  if event.cycle == 3 then print("the script of " .. tostring(self) .. " runs in cycle " .. event.cycle) end
end)
