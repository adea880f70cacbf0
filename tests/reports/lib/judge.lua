-- Functions with which a case says what it has seen.

--- Prints whether `good` holds.
function judge(what, good)
  print((good and "right: " or "wrong: ") .. what)
end

--- Prints whether `seen` differs from `expected` by at most `tolerance`; NaN is wrong.
function near(what, seen, expected, tolerance)
  judge(string.format("%s is %.6g, expected %.6g within %.2g", what, seen, expected, tolerance),
        math.abs(seen - expected) <= tolerance)
end
