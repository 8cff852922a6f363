// Where a value sits on a slider, 0 to 1, and back. Quantities that span decades move by factors, not by amounts.

export type Scale =
    | { kind: 'linear'; low: number; high: number }
    | { kind: 'log'; low: number; high: number }
    /** Both signs: linear below `unit`, logarithmic beyond. */
    | { kind: 'signed'; high: number; unit: number };

export function toFraction(scale: Scale, value: number): number {
    let fraction: number;
    switch (scale.kind) {
        case 'linear':
            fraction = (value - scale.low) / (scale.high - scale.low);
            break;
        case 'log':
            fraction = Math.log(Math.max(value, scale.low) / scale.low) / Math.log(scale.high / scale.low);
            break;
        case 'signed':
            fraction = 0.5 + (0.5 * Math.asinh(value / scale.unit)) / Math.asinh(scale.high / scale.unit);
    }
    return Math.min(1, Math.max(0, fraction));
}

export function fromFraction(scale: Scale, fraction: number): number {
    switch (scale.kind) {
        case 'linear':
            return tidy(scale.low + fraction * (scale.high - scale.low));
        case 'log':
            return tidy(scale.low * (scale.high / scale.low) ** fraction);
        case 'signed':
            return tidy(scale.unit * Math.sinh((2 * fraction - 1) * Math.asinh(scale.high / scale.unit)));
    }
}

/** Three significant digits: what a hand on a slider means. */
export function tidy(value: number): number {
    return Number(value.toPrecision(3));
}

/** A number as a person reads it. */
export function words(value: number | null | undefined, digits = 3): string {
    if (value === null || value === undefined || !Number.isFinite(value)) return '–';
    const size = Math.abs(value);
    const whole = size >= 1 ? Math.ceil(Math.log10(size + 1)) : 0;
    const rounded = Number(value.toPrecision(Math.min(100, Math.max(digits, whole))));
    const isPlain = size === 0 || (size >= 1e-4 && size < 1e7);
    return isPlain ? String(rounded) : Number(value.toPrecision(digits)).toExponential().replace('e+', 'e');
}
