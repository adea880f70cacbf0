/// A WebSocket that reconnects after a loss, with increasing delays.

/// The part of WebSocket that is used; tests substitute their own.
export interface Socket {
  binaryType: string;
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: never) => void) | null;
  onerror: ((event: never) => void) | null;
  send(data: string): void;
  close(): void;
}

export type Connect = (url: string) => Socket;

export const connectSocket: Connect = (url) => new WebSocket(url) as unknown as Socket;

const kFirstWait = 300, kLongestWait = 5000;

export class Connection {
  state: "connecting" | "open" | "lost" = "connecting";
  onopen: () => void = () => {};
  onlost: () => void = () => {};
  ontext: (text: string) => void = () => {};
  onbinary: (bytes: Uint8Array) => void = () => {};

  private socket: Socket | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private wait = kFirstWait;
  private over = false;

  constructor(
    private readonly url: string,
    private readonly connect: Connect,
  ) {}

  open(): void {
    this.drop();
    if (this.over) return;
    let socket: Socket;
    try {
      socket = this.connect(this.url);
    } catch {
      return this.lost();
    }
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.state = "open";
      this.onopen();
    };
    socket.onmessage = ({ data }) => {
      if (typeof data === "string") this.ontext(data);
      else if (data instanceof ArrayBuffer) this.onbinary(new Uint8Array(data));
    };
    socket.onclose = socket.onerror = () => this.lost();
  }

  /// The data was valid: the next reconnection starts with a short delay.
  proven(): void {
    this.wait = kFirstWait;
  }

  /// Reconnects, because the data was invalid.
  again(): void {
    this.lost();
  }

  /// Returns false if there is no connection.
  send(message: unknown): boolean {
    if (this.state !== "open" || !this.socket) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  close(): void {
    this.over = true;
    clearTimeout(this.timer);
    this.drop();
  }

  private lost(): void {
    this.drop();
    if (this.over) return;
    if (this.state === "open") this.state = "lost";
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(kLongestWait, 1.7 * this.wait);
    this.onlost();
  }

  private drop(): void {
    const { socket } = this;
    this.socket = null;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    // Ignore errors of an abandoned socket.
    socket.onerror = () => {};
    socket.close();
  }
}
