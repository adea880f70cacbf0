local args = ...
on("prepare", function(self, event)
  local drawn = math.random()
  if event.cycle == 5 then print(string.format("%s drew %.6f", args.name, drawn)) end
end)
