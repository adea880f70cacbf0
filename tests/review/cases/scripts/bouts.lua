on("prepare", function(self, event)
  if event.cycle <= 10 then Sumo.bouts = Sumo.bouts + 1 end
end)
