/// Chooses the notice if there is no match to show.
import type { NoticeAction } from "./notice";
import type { Openings } from "./openings";
import type { Showing } from "./showing";

export interface NoticeText {
  title: string;
  words: string;
  /// Progress of loading, 0..1; null: nothing is being loaded.
  share: number | null;
  actions: NoticeAction[];
}

/// Delay before the notice "connecting" is shown [ms].
const kPatience = 1200;

/// Returns null if there is a match to show. `waited`: time since the source was selected [ms]; `host` as in the
/// address bar.
export function noticeOf(showing: Showing, waited: number, host: string, openings: Pick<Openings, "choose">): NoticeText | null {
  const open: NoticeAction = { text: "Open a log", testid: "notice-open", run: () => openings.choose() };
  if (showing.loading) return { title: `Opening ${showing.loading.name}`, words: "", share: showing.loading.share, actions: [] };
  if (showing.failure) return { ...showing.failure, share: null, actions: failed(showing, open) };
  if (showing.source.world.nodes.length > 0 || !showing.live || waited < kPatience) return null;
  if (showing.live.state === "open") return { title: "Waiting for the match", words: "The host has not sent a scene yet.", share: null, actions: [open] };
  const words = `There is no answer from ${host}. The page tries again by itself. A recorded match can be watched without a host: drop its log or recording here.`;
  return { title: "No host", words, share: null, actions: [{ ...open, main: true }] };
}

function failed(showing: Showing, open: NoticeAction): NoticeAction[] {
  const back: NoticeAction = { text: "Back", testid: "notice-back", run: () => showing.forgive() };
  const live: NoticeAction = { text: "Watch the live match", testid: "notice-live", run: () => showing.watchLive() };
  return [{ ...open, text: "Open another", main: true }, showing.source.world.nodes.length > 0 ? back : live];
}
