/// Ways to open a log or a recording: file dialog, drag and drop, or address.
import { h } from "./dom";

export class Openings {
  private readonly input = h("input", { type: "file", class: "unseen", "data-testid": "file-input", tabindex: "-1", "aria-label": "Log or recording", accept: ".log,.gz,.txt,.mcap,text/plain,application/gzip" });
  private readonly zone = h("div", { class: "drop", "data-testid": "drop-zone", hidden: true }, "Drop the log or recording here");
  readonly elements = [this.input, this.zone];

  constructor(opened: (file: File) => void) {
    this.input.addEventListener("change", () => {
      const file = this.input.files?.[0];
      if (file) opened(file);
      this.input.value = "";   // the same file may be chosen again
    });
    const carriesFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    window.addEventListener("dragover", (event) => {
      if (!carriesFile(event)) return;
      event.preventDefault();
      this.zone.hidden = false;
    });
    // leaving the window: there is no related element
    window.addEventListener("dragleave", (event) => event.relatedTarget === null && (this.zone.hidden = true));
    window.addEventListener("drop", (event) => {
      this.zone.hidden = true;
      const file = event.dataTransfer?.files[0];
      if (!carriesFile(event)) return;
      event.preventDefault();
      if (file) opened(file);
    });
  }

  choose(): void {
    this.input.click();
  }
}
