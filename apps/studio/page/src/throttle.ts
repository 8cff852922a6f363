/** Calls `action` with the newest argument, at most once in `wait` milliseconds; the last one is never dropped. */
export class Throttle<T> {
    private pending: { value: T } | null = null;
    private timer: ReturnType<typeof setTimeout> | undefined;
    private last = -Infinity;

    constructor(
        private readonly wait: number,
        private readonly action: (value: T) => void,
    ) {}

    push(value: T): void {
        this.pending = { value };
        if (this.timer !== undefined) return;
        const rest = this.last + this.wait - performance.now();
        if (rest <= 0) this.flush();
        else this.timer = setTimeout(() => this.flush(), rest);
    }

    /** Sends now what waits. */
    flush(): void {
        clearTimeout(this.timer);
        this.timer = undefined;
        if (!this.pending) return;
        const { value } = this.pending;
        this.pending = null;
        this.last = performance.now();
        this.action(value);
    }
}
