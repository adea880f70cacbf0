/// Adapts the resolution to the machine: fewer pixels if pictures take too long for a while, more if there is time to
/// spare.
export class Budget {
  /// Fraction of the full resolution along each edge, 0.5..1.
  share = 1;
  private slow = 0;
  private fast = 0;

  /// Receives the duration of the last of consecutive pictures [ms]. Returns true if the fraction changed.
  heard(milliseconds: number): boolean {
    // A single long picture is a scene being built or a page that was hidden; many are a slow machine.
    if (milliseconds > 3000) return false;
    this.slow = milliseconds > 38 ? this.slow + Math.min(6, milliseconds / 38) : Math.max(0, this.slow - 2);
    this.fast = milliseconds < 21 ? this.fast + 1 : 0;
    if (this.slow > 25 && this.share > 0.5) return this.change(Math.max(0.5, this.share * 0.84));
    if (this.fast > 240 && this.share < 1) return this.change(Math.min(1, this.share / 0.84));
    return false;
  }

  reset(): void {
    this.share = 1;
    this.slow = this.fast = 0;
  }

  private change(share: number): boolean {
    this.share = share;
    this.slow = this.fast = 0;
    return true;
  }
}
