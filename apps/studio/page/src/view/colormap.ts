// A perceptual colour map: lightness rises evenly from dark to bright while the hue turns once, so that equal steps of a
// value look equal, in grey and to colour-blind eyes too. Made here from OKLCh curves.

const size = 256;

/** sRGB, 0 to 1, of OKLCh lightness, chroma and hue (radians). */
function fromOklch(lightness: number, chroma: number, hue: number): [number, number, number] {
    const a = chroma * Math.cos(hue);
    const b = chroma * Math.sin(hue);
    const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
    const linear = [
        4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
        -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
    return linear.map((x) => {
        const clamped = Math.min(1, Math.max(0, x));
        return clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * clamped ** (1 / 2.4) - 0.055;
    }) as [number, number, number];
}

function makeTable(): Float32Array {
    const table = new Float32Array(size * 3);
    for (let i = 0; i < size; ++i) {
        const x = i / (size - 1);
        // From deep violet over blue and green to a warm yellow.
        const color = fromOklch(0.28 + 0.62 * x, 0.11 + 0.05 * Math.sin(Math.PI * x), ((300 - 200 * x) * Math.PI) / 180);
        table.set(color, i * 3);
    }
    return table;
}

const srgb = makeTable();
const toLinear = (x: number): number => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const linear = srgb.map(toLinear);
/** Where there is no value: grey. */
const none = toLinear(0.6);

/** Writes linear colours of the scalars, laid from low to high, to `colors`, three numbers each. */
export function colorScalars(scalars: Float32Array, low: number, high: number, colors: Float32Array): void {
    const scale = high > low ? (size - 1) / (high - low) : 0;
    for (let i = 0; i < scalars.length; ++i) {
        const value = scalars[i]!;
        const at = i * 3;
        if (Number.isNaN(value)) {
            colors[at] = colors[at + 1] = colors[at + 2] = none;
            continue;
        }
        const place = (value - low) * scale;
        const entry = (place <= 0 ? 0 : place >= size - 1 ? size - 1 : Math.round(place)) * 3;
        colors[at] = linear[entry]!;
        colors[at + 1] = linear[entry + 1]!;
        colors[at + 2] = linear[entry + 2]!;
    }
}

/** The map as a CSS gradient. */
export function cssGradient(direction: string, stops = 16): string {
    const colors = Array.from({ length: stops }, (_, i) => {
        const entry = Math.round((i / (stops - 1)) * (size - 1)) * 3;
        return `rgb(${[0, 1, 2].map((k) => Math.round(srgb[entry + k]! * 255)).join(' ')})`;
    });
    return `linear-gradient(${direction}, ${colors.join(', ')})`;
}
