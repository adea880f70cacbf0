-- row: 24
-- input: trainer commands of a match: nothing, words without parentheses, more arguments than count, parts twice, for
--    selected players when none is selected
-- right: each is answered, the log has each kind once, and the rest of a message has its effect
-- args: --agent-port 0 --monitor-port 0 --web-port 0 --duration 0.5
-- exit: 0
-- expect: expected commands in parentheses, found none
include "soccer-sphere.lua"
include "../lib/judge.lua"
local monitor = get("/sys/server/monitor")
local wrong = {
  { "", "expected commands in parentheses, found none" },
  { "; nothing\n", "expected commands in parentheses, found none" },
  { "kickOff Left", "expected a command in parentheses, found 'kickOff'" },
  { "()", "without a name" },
  { "(reqfullstate now)", "reqfullstate: expected no arguments, found 1" },
  { "(dropBall here)", "dropBall: expected 0 arguments, found 1" },
  { "(kickOff Left Right)", "kickOff: expected 1 argument, found 2" },
  { "(ball (pos 1 2 0.2) (pos 4 5 6))", "ball: found 'pos' again, which is ignored" },
  { "(agent)", "agent: no such player" },
  { "(select)", "select: no such player" },
  { "(score (left 2) (right 1) (draw 3))", "score: found 'draw', which is ignored" },
  { "(time -4)(tim 4)", "time: expected a time" },
  { "(time -4)(tim 4)", "; there is no command 'tim' here. Did you mean 'time'?" },
}
on("rule", function(self, event)
  if event.cycle == 5 then
    for _, w in ipairs(wrong) do
      local ok, why = pcall(monitor.command, monitor, w[1])
      why = ok and "no answer" or tostring(why)
      judge(("'%s': %s"):format(w[1], why:match("[^\n]*$")), not ok and why:find(w[2], 1, true))
    end
    judge("what is right has no answer", pcall(monitor.command, monitor, "(init)(getAck x)(time 12)"))
  end
  if event.cycle == 10 then
    local state = get("/sys/server/gamecontrol/GameStateAspect")
    judge("what was right beside it acts", state.score[1] == 2 and state.score[2] == 1)
  end
end)
