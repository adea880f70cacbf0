/// Which sets of drawings are shown. Names have parts, "ball.path.3". A rule for "ball" applies to all sets below it,
/// including future ones; the longest matching rule decides. A set that matches no rule is shown.
export class SetSwitches {
  private readonly rules = new Map<string, boolean>();
  version = 0;

  isOn(name: string): boolean {
    for (let rule = name; ; rule = rule.slice(0, rule.lastIndexOf("."))) {
      const on = this.rules.get(rule);
      if (on !== undefined) return on;
      if (!rule.includes(".")) return this.rules.get("") ?? true;
    }
  }

  /// Switches a set on or off, or all sets whose names begin with this prefix ("": all sets).
  switch(prefix: string, on: boolean): void {
    for (const rule of [...this.rules.keys()]) if (covers(prefix, rule)) this.rules.delete(rule);
    if (this.rules.size === 0 && prefix === "") {
      if (!on) this.rules.set("", false);
    } else if (this.isOn(prefix) !== on) {
      this.rules.set(prefix, on);
    }
    ++this.version;
  }
}

function covers(prefix: string, name: string): boolean {
  return prefix === "" || name === prefix || name.startsWith(`${prefix}.`);
}

/// A line of the list of sets: one set, or all sets whose names have the same first part.
export interface SetRow {
  prefix: string;
  label: string;
  /// Names of the sets in the group.
  names: string[];
  nested: boolean;
}

/// Lists the sets by name. Sets with a common first part are grouped below a line of their own.
export function setRows(names: Iterable<string>): SetRow[] {
  const groups = new Map<string, string[]>();
  for (const name of [...names].sort()) {
    const first = name.split(".")[0]!;
    groups.set(first, [...(groups.get(first) ?? []), name]);
  }
  return [...groups].flatMap(([first, members]) => {
    const single = (name: string, nested: boolean): SetRow => ({ prefix: name, label: nested ? name.slice(first.length) || name : name || "(no name)", names: [name], nested });
    if (members.length === 1) return [single(members[0]!, false)];
    return [{ prefix: first, label: first, names: members, nested: false }, ...members.map((m) => single(m, true))];
  });
}
