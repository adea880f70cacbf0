/// The notice in the middle of an empty picture: waiting, loading, or the reason why nothing is shown.
import { h, setHidden, setText } from "./dom";

export interface NoticeAction {
  text: string;
  testid: string;
  main?: boolean;
  run: () => void;
}

export class Notice {
  private readonly title = h("h2", {});
  private readonly words = h("p", { class: "dim" });
  private readonly share = h("i", {});
  private readonly progress = h("div", { class: "progress" }, this.share);
  private readonly actions = h("div", { class: "row" });
  readonly element = h(
    "div",
    { class: "notice", hidden: true },
    h("div", { class: "card", "data-testid": "notice", role: "status" }, this.title, this.words, this.progress, this.actions),
  );
  private shown = "";

  /// `share`: progress of loading, 0..1; null: nothing is being loaded.
  show(title: string, words: string, share: number | null, actions: NoticeAction[]): void {
    setHidden(this.element, false);
    setText(this.title, title);
    setText(this.words, words);
    setHidden(this.progress, share === null);
    this.share.style.transform = `scaleX(${share ?? 0})`;
    const names = actions.map((a) => a.text).join("\n");
    if (names === this.shown) return;   // buttons keep their focus
    this.shown = names;
    this.actions.replaceChildren(
      ...actions.map((a) => h("button", { type: "button", class: a.main ? "button main" : "button", "data-testid": a.testid, onclick: a.run }, a.text)),
    );
  }

  hide(): void {
    setHidden(this.element, true);
    this.shown = "";
  }
}
