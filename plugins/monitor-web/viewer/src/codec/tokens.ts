/// Reads lists of atoms from bytes, in both languages of monitor messages: (time 0.8) and ["time",0.8]. Scans the bytes
/// without copying. An atom is converted to a number or a string only on request.

export const enum Token {
  open,
  close,
  atom,
  /// End of the bytes.
  end,
}

const kSpace = 0x20, kQuote = 0x22, kComma = 0x2c, kBackslash = 0x5c;
const kParenOpen = 0x28, kParenClose = 0x29, kBracketOpen = 0x5b, kBracketClose = 0x5d;

/// 10^0 .. 10^22 are exact. Other exponents are left to the JavaScript engine's parser.
const kPowers = Array.from({ length: 23 }, (_, i) => 10 ** i);
const kMaxDigits = 15;

const decoder = new TextDecoder();

export class Tokens {
  /// The last atom: bytes [from, to), without quotes.
  from = 0;
  to = 0;
  /// The atom was quoted, so it is a string even if it looks like a number.
  quoted = false;
  /// Offset of the next token.
  at = 0;

  private bytes: Uint8Array = new Uint8Array();
  private end = 0;
  private json = false;
  private escaped = false;

  /// Starts at `from`. The language is JSON if the first list opens with a bracket.
  start(bytes: Uint8Array, from: number, end: number): void {
    this.bytes = bytes;
    this.at = from;
    this.end = end;
    while (this.at < end && bytes[this.at]! <= kSpace) ++this.at;
    this.json = bytes[this.at] === kBracketOpen;
  }

  next(): Token {
    const { bytes, end, json } = this;
    let at = this.at;
    while (at < end && (bytes[at]! <= kSpace || (json && bytes[at] === kComma))) ++at;
    if (at >= end) {
      this.at = at;
      return Token.end;
    }
    const first = bytes[at]!;
    if (first === (json ? kBracketOpen : kParenOpen)) return this.one(at, Token.open);
    if (first === (json ? kBracketClose : kParenClose)) return this.one(at, Token.close);
    if (first === kQuote) return this.word(at + 1);
    this.quoted = false;
    this.from = at;
    if (json) while (at < end && bytes[at]! > kSpace && bytes[at] !== kComma && bytes[at] !== kBracketClose && bytes[at] !== kBracketOpen) ++at;
    else while (at < end && bytes[at]! > kSpace && bytes[at] !== kParenOpen && bytes[at] !== kParenClose) ++at;
    this.to = this.at = at;
    return Token.atom;
  }

  /// Skips to the end of the innermost open list. Returns false if the bytes end first.
  skip(): boolean {
    for (let depth = 1; depth > 0; ) {
      const token = this.next();
      if (token === Token.end) return false;
      if (token === Token.open) ++depth;
      if (token === Token.close) --depth;
    }
    return true;
  }

  /// Returns true if the atom is this word. ASCII only.
  is(word: string): boolean {
    if (this.to - this.from !== word.length) return false;
    for (let i = 0; i < word.length; ++i) if (this.bytes[this.from + i] !== word.charCodeAt(i)) return false;
    return true;
  }

  text(): string {
    const raw = decoder.decode(this.bytes.subarray(this.from, this.to));
    if (!this.escaped || !this.quoted) return raw;
    if (!this.json) return raw.replace(/\\(.)/g, "$1");
    try {
      return String(JSON.parse(`"${raw}"`));
    } catch {
      return raw;
    }
  }

  /// The atom as a number; NaN if it is not one.
  number(): number {
    const { bytes, to } = this;
    let at = this.from;
    const negative = bytes[at] === 0x2d;
    if (negative || bytes[at] === 0x2b) ++at;
    let mantissa = 0, digits = 0, exponent = 0, any = false, point = false;
    for (; at < to; ++at) {
      const c = bytes[at]!;
      if (c === 0x2e && !point) {
        point = true;
        continue;
      }
      if (c < 0x30 || c > 0x39) break;
      any = true;
      if (digits > 0 || c !== 0x30) ++digits;
      mantissa = mantissa * 10 + (c - 0x30);
      if (point) --exponent;
    }
    if (!any || digits > kMaxDigits) return this.slowNumber();
    if (at < to) {
      if ((bytes[at]! | 0x20) !== 0x65) return this.slowNumber();
      let scale = 0;
      const down = bytes[++at] === 0x2d;
      if (down || bytes[at] === 0x2b) ++at;
      if (at >= to || to - at > 3) return this.slowNumber();
      for (; at < to; ++at) {
        const c = bytes[at]!;
        if (c < 0x30 || c > 0x39) return this.slowNumber();
        scale = scale * 10 + (c - 0x30);
      }
      exponent += down ? -scale : scale;
    }
    if (exponent < -22 || exponent > 22) return this.slowNumber();
    const value = exponent < 0 ? mantissa / kPowers[-exponent]! : mantissa * kPowers[exponent]!;
    return negative ? -value : value;
  }

  /// The atom as a number if it looks like one, otherwise as a string.
  value(): string | number {
    if (this.quoted) return this.text();
    const number = this.number();
    return Number.isNaN(number) ? this.text() : number;
  }

  private slowNumber(): number {
    const text = this.text();
    return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(text) ? Number(text) : NaN;
  }

  private one(at: number, token: Token): Token {
    this.at = at + 1;
    return token;
  }

  private word(at: number): Token {
    const { bytes, end } = this;
    this.quoted = true;
    this.escaped = false;
    this.from = at;
    while (at < end && bytes[at] !== kQuote) {
      if (bytes[at] === kBackslash) {
        this.escaped = true;
        ++at;
      }
      ++at;
    }
    if (at >= end) {
      this.at = end;
      return Token.end;
    }
    this.to = at;
    this.at = at + 1;
    return Token.atom;
  }
}
