/// Switches for the rules of the running match: the children of game control that have a property `enabled`.
import type { NodeInfo, TreeAnswer } from "../inspect/inspectable";
import type { LiveSource } from "../model";
import { h, Pace } from "./dom";

const kRules = "/sys/server/gamecontrol";
/// How often rules that a config or a script adds are looked for [ms].
const kLookEvery = 5000;

/// A rule's name as a title: "OffsideAspect" is "Offside", "KickInRule" is "Kick in".
export function ruleTitle(name: string): string {
  const words = name
    .replace(/(Aspect|Rule)$/, "")
    .replace(/([a-z0-9])([A-Z])/g, "$1 $2")
    .toLowerCase()
    .trim();
  return words === "" ? name : words[0]!.toUpperCase() + words.slice(1);
}

interface Rule {
  row: HTMLElement;
  input: HTMLInputElement;
  unwatch(): void;
}

export class RuleSwitches {
  readonly element = h("div", { class: "rules", "data-testid": "rules" });
  private readonly pace = new Pace(kLookEvery);
  private readonly rules = new Map<string, Rule>();
  /// Nodes without that property.
  private readonly others = new Set<string>();
  private source: LiveSource | null = null;

  /// `say` reports a switch that was set, or the reason why not.
  constructor(private readonly say: (text: string, ok: boolean) => void) {}

  /// A few times a second while the referee sees the switches.
  update(live: LiveSource, now: number): void {
    if (live !== this.source) this.begin(live);
    if (live.connected && this.pace.due(now)) void this.look(live).catch(() => this.pace.hurry());
  }

  private begin(live: LiveSource): void {
    for (const name of [...this.rules.keys()]) this.forget(name);
    this.others.clear();
    this.source = live;
    this.pace.hurry();
  }

  private async look(live: LiveSource): Promise<void> {
    const { tree } = await live.ask<{ tree: TreeAnswer }>({ do: "tree", path: kRules, depth: 1 });
    for (const { name } of tree.children ?? []) {
      if (this.rules.has(name) || this.others.has(name)) continue;
      const { properties } = await live.ask<NodeInfo>({ do: "get", path: `${kRules}/${name}` });
      if (live !== this.source) return;
      if (this.rules.has(name)) continue;
      const enabled = properties.find((p) => p.name === "enabled");
      if (enabled) this.add(live, name, enabled.value === true, enabled.doc);
      else this.others.add(name);
    }
  }

  private add(live: LiveSource, name: string, on: boolean, doc: string): void {
    const input = h("input", { type: "checkbox", "data-testid": `rule-${name}`, onchange: () => void this.set(live, name, input) });
    input.checked = on;
    const row = h("label", { class: "rule", title: doc }, input, h("span", {}, ruleTitle(name)));
    const unwatch = live.watch(
      `${kRules}/${name}`,
      "enabled",
      (value) => (input.checked = value === true),
      () => this.forget(name),
    );
    this.rules.set(name, { row, input, unwatch });
    this.element.append(row);
  }

  private forget(name: string): void {
    const rule = this.rules.get(name);
    if (!rule) return;
    this.rules.delete(name);
    rule.unwatch();
    rule.row.remove();
  }

  private async set(live: LiveSource, name: string, input: HTMLInputElement): Promise<void> {
    const wanted = input.checked;
    try {
      await live.ask({ do: "set", path: `${kRules}/${name}`, property: "enabled", value: String(wanted) });
      this.say(`${ruleTitle(name)}: ${wanted ? "on" : "off"}.`, true);
    } catch (error) {
      input.checked = !wanted;
      this.say(`${ruleTitle(name)}: refused, ${error instanceof Error ? error.message : String(error)}`, false);
    }
  }
}
