// A small curve on a canvas: one value a step, linear or logarithmic, with a rule where the level changes.

import { words } from './scale';

export interface Range {
    low: number;
    high: number;
}

/** The range that a curve is drawn in: whole decades on a log axis, a little air on a linear one; null for no values. */
export function plotRange(values: readonly (number | null)[], isLog: boolean): Range | null {
    let low = Infinity;
    let high = -Infinity;
    for (const value of values) {
        if (value === null || !Number.isFinite(value) || (isLog && value <= 0)) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
    }
    if (low > high) return null;
    if (isLog) {
        const from = Math.floor(Math.log10(low) + 1e-9);
        const to = Math.ceil(Math.log10(high) - 1e-9);
        return { low: 10 ** from, high: 10 ** Math.max(to, from + 1) };
    }
    const air = (high - low || Math.abs(high) || 1) * 0.08;
    return { low: low - air, high: high + air };
}

/** 0 at the range's low end, 1 at its high end. */
export function plotHeight(value: number, range: Range, isLog: boolean): number {
    return isLog
        ? Math.log(value / range.low) / Math.log(range.high / range.low)
        : (value - range.low) / (range.high - range.low);
}

/** The places of `count` values of which every one in a column of the picture would be too many: at most `most`. */
export function thinned(count: number, most: number): number[] {
    if (count <= most) return Array.from({ length: count }, (_, i) => i);
    return Array.from({ length: most }, (_, i) => Math.round((i * (count - 1)) / (most - 1)));
}

export interface PlotData {
    values: readonly (number | null)[];
    levels: readonly number[];
}

export class Plot {
    readonly canvas = document.createElement('canvas');
    private data: PlotData = { values: [], levels: [] };
    private isScheduled = false;

    constructor(
        private readonly isLog: boolean,
        private readonly colorName: string,
    ) {
        this.canvas.className = 'plot';
        this.canvas.setAttribute('aria-hidden', 'true');
        new ResizeObserver(() => this.schedule()).observe(this.canvas);
    }

    show(data: PlotData): void {
        this.data = data;
        this.schedule();
    }

    schedule(): void {
        if (this.isScheduled) return;
        this.isScheduled = true;
        requestAnimationFrame(() => {
            this.isScheduled = false;
            this.draw();
        });
    }

    private draw(): void {
        const ratio = window.devicePixelRatio || 1;
        const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
        const pixels = [Math.round(width * ratio), Math.round(height * ratio)] as const;
        if (this.canvas.width !== pixels[0]) this.canvas.width = pixels[0];
        if (this.canvas.height !== pixels[1]) this.canvas.height = pixels[1];
        const context = this.canvas.getContext('2d');
        if (!context || width === 0) return;
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        context.clearRect(0, 0, width, height);
        const range = plotRange(this.data.values, this.isLog);
        if (!range) return;
        const style = getComputedStyle(this.canvas);
        const font = parseFloat(style.fontSize);
        const area = { left: font * 3.6, right: width - 3, top: font * 0.5, bottom: height - font * 0.5 };
        this.drawAxis(context, range, area, style, font);
        this.drawCurve(context, range, area, style, font);
    }

    private drawAxis(
        context: CanvasRenderingContext2D, range: Range, area: Area, style: CSSStyleDeclaration, font: number,
    ): void {
        context.font = `${font * 0.92}px ${style.fontFamily}`;
        context.fillStyle = style.getPropertyValue('--quiet');
        context.strokeStyle = style.getPropertyValue('--line');
        context.lineWidth = 1;
        context.textAlign = 'right';
        context.textBaseline = 'middle';
        for (const value of [range.low, range.high]) {
            const y = area.bottom - plotHeight(value, range, this.isLog) * (area.bottom - area.top);
            context.beginPath();
            context.moveTo(area.left, y);
            context.lineTo(area.right, y);
            context.stroke();
            context.fillText(words(value, 2), area.left - font * 0.4, y);
        }
    }

    private drawCurve(
        context: CanvasRenderingContext2D, range: Range, area: Area, style: CSSStyleDeclaration, font: number,
    ): void {
        const { values, levels } = this.data;
        const across = (i: number): number =>
            area.left + (values.length > 1 ? i / (values.length - 1) : 1) * (area.right - area.left);
        context.strokeStyle = style.getPropertyValue('--quiet');
        context.setLineDash([2, 3]);
        for (let i = 1; i < levels.length; ++i) {
            if (levels[i] === levels[i - 1]) continue;
            context.beginPath();
            context.moveTo(across(i - 0.5), area.top);
            context.lineTo(across(i - 0.5), area.bottom);
            context.stroke();
        }
        context.setLineDash([]);
        context.strokeStyle = style.getPropertyValue(this.colorName);
        context.lineWidth = font * 0.14;
        context.lineJoin = 'round';
        context.beginPath();
        let isDown = false;
        let last: [number, number] | null = null;
        for (const i of thinned(values.length, Math.max(2, 2 * Math.round(area.right - area.left)))) {
            const value = values[i];
            if (value === null || value === undefined || !Number.isFinite(value) || (this.isLog && value <= 0)) {
                isDown = false;
                continue;
            }
            last = [across(i), area.bottom - plotHeight(value, range, this.isLog) * (area.bottom - area.top)];
            if (isDown) context.lineTo(...last);
            else context.moveTo(...last);
            isDown = true;
        }
        context.stroke();
        if (!last) return;
        context.fillStyle = context.strokeStyle;
        context.beginPath();
        context.arc(last[0], last[1], font * 0.22, 0, 2 * Math.PI);
        context.fill();
    }
}

interface Area {
    left: number;
    right: number;
    top: number;
    bottom: number;
}
