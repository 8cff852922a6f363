// What the page itself sees of the speed: steps that arrive, and how long a change takes to be on the screen.

const span = 2000;

export class Meter {
    private arrivals: number[] = [];
    private edit: { sent: number; step: number; isKnown: boolean } | null = null;
    private shown: number | null = null;

    /** A step's sample has come. */
    step(now: number): void {
        this.arrivals.push(now);
        while (this.arrivals.length > 0 && this.arrivals[0]! < now - span) this.arrivals.shift();
    }

    /** Steps a second over the last two seconds; null where too few have come. */
    stepsPerSecond(now: number): number | null {
        const recent = this.arrivals.filter((time) => time >= now - span);
        if (recent.length < 3) return null;
        return ((recent.length - 1) * 1000) / (recent[recent.length - 1]! - recent[0]!);
    }

    /** Of the changes of a drag the first counts that has yet to be seen, unless it is so old that nothing ran then. */
    edited(now: number, step: number): void {
        if (!this.edit || now - this.edit.sent > span) this.edit = { sent: now, step, isKnown: false };
    }

    /** The server has said that the scene has changed: a step after this one knows of it. */
    acknowledged(step: number): void {
        if (this.edit && !this.edit.isKnown) this.edit = { ...this.edit, step: Math.max(step, this.edit.step), isKnown: true };
    }

    positions(now: number, step: number): void {
        if (!this.edit?.isKnown || step <= this.edit.step) return;
        this.shown = now - this.edit.sent;
        this.edit = null;
    }

    get editShown(): number | null {
        return this.shown;
    }
}
