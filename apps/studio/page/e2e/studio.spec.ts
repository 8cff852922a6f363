import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import type { StudioPage } from './harness';
import { Studio, holdsTimes, isFake, program } from './harness';

interface Moved {
    name: string;
    motion: { translate?: number[] }[];
}

interface Known {
    status: { state: string; message: string; level: number; levels: number; step: number };
    session: {
        can_undo: boolean;
        scene: {
            name: string; gravity: number[]; bodies: { pressure: number; material: { strain_limit: number | null } }[];
            handles: Moved[]; obstacles: Moved[]; loads: { force: number[] }[]; hierarchy: { operator: string };
        };
    };
    samples: unknown[];
    frames: unknown[];
    parts: { pulls: unknown[]; handles: { place: number[] }[]; obstacles: { place: number[] }[] };
    edges: boolean;
    color: string;
}

const studio = new Studio();
let tab: StudioPage;

beforeAll(async () => {
    await studio.start();
    tab = await studio.page();
});
afterAll(async () => {
    await studio.stop();
});

async function play(page: StudioPage, steps: number): Promise<void> {
    const from = await page.step();
    if ((await page.readout('state')) !== 'playing') await page.press(' ');
    await page.waitForState('playing', 'at_rest');
    await page.waitForStep(from + steps);
}

async function pause(page: StudioPage): Promise<void> {
    if ((await page.readout('state')) === 'playing') await page.press(' ');
    await page.waitForState('idle', 'at_rest');
}

/** What is read twice in a row, a little apart. */
async function settled<T>(read: () => Promise<T>): Promise<T> {
    for (let last = await read(); ; ) {
        await tab.page.waitForTimeout(150);
        const next = await read();
        if (JSON.stringify(next) === JSON.stringify(last)) return next;
        last = next;
    }
}

/** By the key. A state between two levels may be refused, with a reason that is shown; the next is another. */
async function refine(page: StudioPage): Promise<void> {
    const word = page.page.locator('.dock .word');
    for (let tries = 0; tries < 6; ++tries) {
        const { level, step } = (await page.state<Known>()).status;
        await page.press('r');
        await expect.poll(async () => `${await page.readout('level')} ${await word.textContent()}`).not.toBe(`${level} `);
        if ((await page.readout('level')) !== String(level)) return;
        const reason = (await page.state<Known>()).status.message;
        expect((await word.textContent())!.toLowerCase()).toBe(reason.toLowerCase());
        console.log(`not refined after ${step} steps: ${reason}`);
        await page.press('.');
        await expect.poll(async () => (await page.state<Known>()).status.step).toBe(step + 1);
    }
    throw new Error('it was never refined');
}

const away = (positions: number[], vertex: number, place: number[]): number =>
    Math.hypot(...place.map((x, k) => positions[vertex * 3 + k]! - x));
const furthest = (a: number[], b: number[]): number => Math.max(...a.map((x, i) => Math.abs(x - b[i]!)));

describe('the gallery', () => {
    it('takes the token out of the address, and shows pictures and a place for files', async () => {
        expect(tab.page.url()).not.toContain('token');
        const images = tab.page.locator('.card img');
        await images.first().waitFor();
        expect(await images.count()).toBeGreaterThan(2);
        await expect.poll(() => images.first().evaluate((img: HTMLImageElement) => img.naturalWidth)).toBeGreaterThan(0);
        expect(await tab.page.locator('.drop').isVisible()).toBe(true);
    });

    it('is reached and opened by keys alone', async () => {
        const focused = (): Promise<string | null> => tab.page.evaluate(() => (document.activeElement as HTMLElement).dataset.gallery ?? null);
        for (let i = 0; i < 12 && (await focused()) === null; ++i) await tab.press('Tab');
        expect(await focused()).not.toBeNull();
        const outline = await tab.page.evaluate(() => getComputedStyle(document.activeElement!).outlineStyle);
        expect(outline).toBe('solid');
        await tab.press('Enter');
        await tab.page.waitForFunction(() => document.querySelector<HTMLElement>('.gallery')!.hidden);
    });
});

describe('the drape', () => {
    it('moves when played', async () => {
        await tab.open('drape');
        const before = await tab.positions();
        await play(tab, 12);
        const speed = await tab.readout('steps');
        const field = tab.page.locator('.number[data-pointer="/gravity"]');
        await field.fill('8');
        await field.press('Enter');
        await expect.poll(() => tab.readout('change')).not.toBe('');
        const change = await tab.readout('change');
        await field.fill('9.81');
        await field.press('Enter');
        await field.blur();
        await pause(tab);
        expect(furthest(await tab.positions(), before)).toBeGreaterThan(1e-3);
        console.log(`${speed} preview steps a second`);
        console.log(`a change of gravity was seen after ${change} ms`);
        if (holdsTimes) expect(Number(speed)).toBeGreaterThanOrEqual(10);
        if (holdsTimes) expect(Number(change)).toBeLessThan(200);
    });

    it('is pulled by a vertex, pinned, and put back exactly by undo', async () => {
        const before = await tab.positions();
        const { step } = (await tab.state<Known>()).status;
        await tab.press('2');
        const box = (await tab.page.locator('.canvas').boundingBox())!;
        const [x, y] = [box.x + box.width * 0.5, box.y + box.height * 0.36];
        await tab.page.mouse.move(x, y);
        await tab.page.mouse.down();
        for (let i = 1; i <= 10; ++i) await tab.page.mouse.move(x + 4 * i, y - 8 * i);
        await tab.page.keyboard.down('Shift');
        await tab.page.mouse.up();
        await tab.page.keyboard.up('Shift');
        await tab.page.waitForFunction(() => document.querySelectorAll('.button.thing[aria-label^="Let go"]').length === 1);
        await play(tab, 2);
        await pause(tab);
        expect(furthest(await tab.positions(), before)).toBeGreaterThan(1e-3);
        await tab.press('Control+z');
        await expect.poll(async () => (await tab.state<Known>()).parts.pulls.length).toBe(0);
        await expect.poll(async () => (await tab.state<Known>()).status.step).toBe(step);
        await expect.poll(async () => furthest(await tab.positions(), before)).toBe(0);
        await tab.press('1');
    });

    it('takes a number, and undo and redo of it', async () => {
        const field = tab.page.locator('.number[data-pointer="/gravity"]');
        const gravity = async (): Promise<number> => (await tab.state<Known>()).session.scene.gravity[1]!;
        await field.fill('4');
        await field.press('Enter');
        await expect.poll(gravity).toBe(-4);
        await tab.page.locator('.canvas').focus().catch(() => {});
        await field.blur();
        await tab.press('Control+z');
        await expect.poll(gravity).toBeCloseTo(-9.81);
        await tab.press('Control+Shift+z');
        await expect.poll(gravity).toBe(-4);
        await tab.press('Control+z');
        await expect.poll(gravity).toBeCloseTo(-9.81);
    });

    it('is shared with every other page', async () => {
        const other = await studio.page({ colorScheme: 'dark' });
        await expect.poll(async () => (await other.positions()).length).toBe((await tab.positions()).length);
        await play(tab, 2);
        await other.waitForState('playing');
        await pause(other);
        await tab.waitForState('idle', 'at_rest');
        await expect.poll(async () => furthest(await other.positions(), await tab.positions())).toBe(0);
        await other.context.close();
    });

    it('loses nothing when the page is loaded again, nor when the connection is', async () => {
        await tab.press('e');
        await tab.press('c');
        await play(tab, 2);
        const before = await tab.state<Known>();
        await tab.page.reload();
        await expect.poll(async () => (await tab.state<Known>()).samples.length).toBeGreaterThanOrEqual(before.samples.length);
        await tab.waitForStep(before.status.step + 1);
        const after = await tab.state<Known>();
        expect(after).toMatchObject({ edges: true, color: 'stretch' });
        expect(after.frames.length).toBeGreaterThanOrEqual(before.frames.length);
        await tab.loseConnection();
        await tab.page.locator('.link-state[data-connection="lost"]').waitFor();
        await tab.page.locator('.link-state[data-connection="open"]').waitFor({ state: 'attached' });
        await tab.waitForStep(after.status.step + 2);
        await pause(tab);
        for (const key of ['e', 'c', 'c', 'c', 'c']) await tab.press(key);
        expect(await tab.state<Known>()).toMatchObject({ edges: false, color: 'none' });
    });

    it('is scrubbed through its saved frames and comes back', async () => {
        const now = await tab.positions();
        const slider = tab.page.locator('#scrub');
        await slider.focus();
        await slider.press('Home');
        await tab.waitForState('frame');
        await expect.poll(async () => furthest(await tab.positions(), now)).toBeGreaterThan(1e-4);
        await slider.blur();
        await tab.press('l');
        await expect.poll(async () => furthest(await tab.positions(), now)).toBe(0);
    });

    it('shows its finest detail by prolongation alone', async () => {
        const coarse = (await tab.positions()).length;
        await tab.press('d');
        await expect.poll(async () => (await tab.positions()).length).toBeGreaterThan(4 * coarse);
        expect(await tab.readout('level')).toBe('0');
        await tab.press('d');
        await expect.poll(async () => (await tab.positions()).length).toBe(coarse);
    });

    it('refines one level, stops on the way, and goes back to the preview', async () => {
        await refine(tab);
        await tab.waitForState('at_rest', 'idle');
        await tab.press('Shift+R');
        await tab.waitForState('refining');
        await tab.press(' ');
        await tab.waitForState('idle', 'at_rest');
        await tab.press('b');
        await expect.poll(() => tab.readout('level')).toBe('0');
    });

    it('leaves the server well when its page is killed while refining', async () => {
        const other = await studio.page();
        await other.waitForState('idle', 'at_rest');
        await other.press('Shift+R');
        await tab.waitForState('refining');
        await other.context.close();
        await tab.waitForState('at_rest');
        expect(studio.isServerAlive).toBe(true);
        const { status } = await tab.state<Known>();
        expect(status.level).toBe(status.levels - 1);
    });

    it.each(['gltf', 'usd', 'pvd', 'pc2', 'obj', 'ply'])('is exported as %s', async (format) => {
        await tab.page.getByRole('button', { name: 'Export', exact: true }).click();
        const [download] = await Promise.all([
            tab.page.waitForEvent('download'), tab.page.locator(`.menu-item[data-format="${format}"]`).click(),
        ]);
        const file = join(studio.folder, download.suggestedFilename());
        await download.saveAs(file);
        expect(readFileSync(file).length).toBeGreaterThan(0);
    });

    it.skipIf(!program || isFake)('has no two faces that intersect', async () => {
        await tab.page.getByRole('button', { name: 'Export', exact: true }).click();
        await tab.page.getByRole('radio', { name: 'This state' }).check();
        const [download] = await Promise.all([
            tab.page.waitForEvent('download'), tab.page.locator('.menu-item[data-format="ply"]').click(),
        ]);
        const file = join(studio.folder, download.suggestedFilename());
        await download.saveAs(file);
        expect(studio.check(file)).toMatchObject({ intersecting_face_pairs: 0 });
    });

    it('is saved', async () => {
        await tab.press('Control+s');
        await tab.page.locator('#save-name').fill('mine');
        await tab.press('Enter');
        const saved = tab.page.locator('.toast', { hasText: 'mine.json' });
        const [download] = await Promise.all([tab.page.waitForEvent('download'), saved.getByRole('button', { name: 'Download' }).first().click()]);
        const file = join(studio.folder, 'saved.json');
        await download.saveAs(file);
        expect(JSON.parse(readFileSync(file, 'utf8'))).toHaveProperty('bodies');
    });
});

describe.skipIf(isFake)('the gizmo', () => {
    it.each([['obstacles', 'ball', 1, -60], ['handles', 'crown', 0, 50]] as const)(
        'moves one of the %s, and undo puts it back', async (list, name, axis, pixels) => {
            await tab.open('drape');
            const { session, parts } = await tab.state<Known>();
            const before = await tab.positions();
            const { place } = parts[list][0]!;
            const nearest = before.flatMap((_, i) => (i % 3 === 0 ? [i / 3] : []))
                .sort((a, b) => away(before, a, place) - away(before, b, place))[0]!;
            await tab.page.locator('.thing', { hasText: name }).click();
            await tab.dragGizmo(place, axis, pixels);
            const motion = async (): Promise<Moved['motion']> => (await tab.state<Known>()).session.scene[list][0]!.motion;
            const moved = async (): Promise<number> => (await motion()).at(-1)?.translate?.[axis] ?? 0;
            await expect.poll(async () => Math.abs(await moved())).toBeGreaterThan(0.02);
            // Another drag is another change.
            const once = await settled(motion);
            const further = once.at(-1)!.translate!;
            await tab.dragGizmo(place.map((x, k) => x + further[k]!), axis, -pixels / 2);
            await expect.poll(motion).not.toEqual(once);
            await settled(motion);
            await tab.press('Control+z');
            await expect.poll(motion).toEqual(once);
            for (let i = 0; i < 2; ++i) {
                const { step } = (await tab.state<Known>()).status;
                await tab.press('.');
                await tab.waitForStep(step + 1);
                await expect.poll(async () => (await tab.state<Known>()).status.step).toBe(step + 1);
            }
            const after = await tab.positions();
            const shift = await moved();
            expect(Math.sign(shift)).toBe(list === 'obstacles' ? -1 : 1);
            expect(after[nearest * 3 + axis]! - before[nearest * 3 + axis]!).toBeCloseTo(shift, 3);
            await tab.press('Control+z');
            await expect.poll(motion).toEqual(session.scene[list][0]!.motion);
            await expect.poll(async () => furthest(await tab.positions(), before)).toBe(0);
            await tab.press('1');
        });
});

describe('the balloon', () => {
    it('grows as its pressure slider is dragged, while it runs', async () => {
        await tab.open('balloon');
        await play(tab, 3);
        const before = Number(await tab.readout('volume'));
        expect(before).toBeGreaterThan(0);
        const slider = tab.page.locator('input[type=range][data-pointer="/bodies/0/pressure"]');
        const box = (await slider.boundingBox())!;
        await tab.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await tab.page.mouse.down();
        for (let i = 1; i <= 12; ++i) {
            await tab.page.mouse.move(box.x + box.width * (0.5 + 0.02 * i), box.y + box.height / 2);
            await tab.page.waitForTimeout(30);
        }
        await tab.page.mouse.up();
        await expect.poll(async () => Number(await tab.readout('volume')) / before, { timeout: 20_000 }).toBeGreaterThan(1.02);
        await pause(tab);
        await tab.press('Control+z');
        await expect.poll(async () => Number(await tab.readout('volume')) / before).toBeLessThan(1.02);
    });
});

describe.skipIf(isFake)('a scene of one’s own', () => {
    const scene = {
        plisse: 1, name: 'loaded',
        bodies: [{ name: 'sheet', mesh: { generate: 'sheet', size: [0.4, 0.4], edge_length: 0.03 } }],
        handles: [{ body: 'sheet', select: { box: [[-1, -1, -1], [-0.19, 1, 1]] } }],
        loads: [{ body: 'sheet', select: { box: [[0.19, -1, -1], [1, 1, 1]] }, force: [0, -0.1, 0] }],
        hierarchy: { levels: 2, coarsest_vertices: 60 },
        solve: { time_step: 0.05, duration: 1, frame_interval: 0.05 },
    };
    const number = (pointer: string) => tab.page.locator(`.number[data-pointer="${pointer}"]`);
    const known = () => tab.state<Known>();
    const parameters = async (): Promise<Known['session']['scene']> => (await known()).session.scene;
    const force = async (): Promise<number[]> => (await parameters()).loads[0]!.force;

    async function step(): Promise<void> {
        const before = (await known()).status.step;
        await tab.press('.');
        await expect.poll(async () => (await known()).status.step).toBe(before + 1);
        await tab.waitForStep(before + 1);
    }

    it('is opened, and its load takes numbers', async () => {
        const buffer = Buffer.from(JSON.stringify(scene));
        await tab.page.locator('#file').setInputFiles({ name: 'loaded.json', mimeType: 'application/json', buffer });
        const yes = tab.page.locator('dialog[open] .primary');
        await yes.or(number('/loads/0/force')).first().waitFor();
        if (await yes.isVisible()) await yes.click();
        await expect.poll(async () => (await parameters()).name).toBe('loaded');
        await tab.waitForState('idle');
        await number('/loads/0/force').fill('0.2');
        await number('/loads/0/force').press('Enter');
        await expect.poll(force).toEqual([0, -0.2, 0]);
        await number('/loads/0/force/0').fill('0.05');
        // A command counts what is typed before it, and is no part of it.
        await tab.press('f');
        await expect.poll(force).toEqual([0.05, -0.2, 0]);
        await tab.press('Control+z');
        await expect.poll(force).toEqual([0, -0.2, 0]);
    });

    it('begins anew with a strain limit, or with another operator', async () => {
        const limit = async (): Promise<number | null> => (await parameters()).bodies[0]!.material.strain_limit;
        await step();
        await number('/bodies/0/material/strain_limit').fill('1.2');
        await number('/bodies/0/material/strain_limit').press('Enter');
        await expect.poll(limit).toBe(1.2);
        await expect.poll(async () => (await known()).status.step).toBe(0);
        await number('/bodies/0/material/strain_limit').fill('');
        await number('/bodies/0/material/strain_limit').press('Enter');
        await expect.poll(limit).toBeNull();
        await number('/bodies/0/material/strain_limit').blur();
        await step();
        await tab.page.locator('summary', { hasText: 'Levels of detail' }).click();
        const operator = tab.page.locator('select[data-pointer="/hierarchy/operator"]');
        expect(await operator.locator('option:disabled').allTextContents()).toEqual(['loop']);
        await operator.selectOption('intrinsic');
        await expect.poll(async () => (await parameters()).hierarchy.operator).toBe('intrinsic');
        await expect.poll(async () => (await known()).status.step).toBe(0);
        await operator.blur();
        await tab.waitForState('idle');
    });

    it('is coloured by gap, but not in the finest detail', async () => {
        const color = tab.page.locator('#color');
        const isThere = (): Promise<boolean> => color.locator('option[value="gap"]').evaluate((option: HTMLOptionElement) => !option.disabled);
        await color.selectOption('gap');
        await color.blur();
        await tab.page.locator('.legend', { hasText: 'Nothing is near enough to touch' }).waitFor();
        await tab.press('d');
        await expect.poll(async () => (await known()).color).toBe('none');
        await tab.page.locator('.toast', { hasText: 'Gaps are kept open' }).waitFor();
        expect(await isThere()).toBe(false);
        await tab.press('d');
        await expect.poll(isThere).toBe(true);
    });

    it('shows the running state when the frame that was looked at is undone', async () => {
        const slider = tab.page.locator('#scrub');
        await step();
        await step();
        const before = await tab.positions();
        await number('/loads/0/force').fill('0.3');
        await number('/loads/0/force').press('Enter');
        await expect.poll(force).toEqual([0, -0.3, 0]);
        await number('/loads/0/force').blur();
        for (let i = 0; i < 3; ++i) await step();
        await slider.focus();
        await slider.press('ArrowLeft');
        await tab.waitForState('frame');
        await slider.blur();
        await tab.press('Control+z');
        await tab.waitForState('idle');
        await expect.poll(async () => furthest(await tab.positions(), before)).toBe(0);
        await step();
        await expect.poll(async () => furthest(await tab.positions(), before)).toBeGreaterThan(0);
    });

    it('is opened again as it was saved, by its name or as the last session', async () => {
        const before = await tab.positions();
        await tab.press('Control+s');
        await tab.page.locator('#save-name').fill('kept');
        await tab.press('Enter');
        await tab.page.locator('.toast', { hasText: 'kept.json' }).waitFor();
        for (const file of ['kept.json', 'last-session.json']) {
            await tab.open('can');
            await tab.page.getByRole('button', { name: 'Open another scene' }).click();
            await tab.page.locator(`.saved-scene[data-file="${file}"]`).click();
            await expect.poll(async () => (await parameters()).name).toBe('loaded');
            await tab.waitForState('idle');
            await expect.poll(async () => JSON.stringify(await tab.positions()) === JSON.stringify(before)).toBe(true);
        }
    });
});

describe('a file', () => {
    const triangles = '# bad\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv .2 .2 -1\nv .2 .2 1\nv .6 .3 1\nf 1 2 3\nf 4 5 6\n';

    it('that cannot be used is shown with what is wrong', async () => {
        await tab.page.locator('#file').setInputFiles({ name: 'bad.obj', mimeType: 'text/plain', buffer: Buffer.from(triangles) });
        const yes = tab.page.locator('dialog[open] .primary');
        if (await yes.isVisible().catch(() => false)) await yes.click();
        await tab.page.locator('.findings').waitFor();
        expect(await tab.page.locator('.findings li').count()).toBeGreaterThan(0);
        await tab.page.getByRole('button', { name: 'Choose another' }).click();
        expect(await tab.page.locator('.gallery').isVisible()).toBe(true);
    });

    it('of another kind is refused with a word', async () => {
        await tab.page.locator('#file').setInputFiles({ name: 'a.blend', mimeType: 'text/plain', buffer: Buffer.from('x') });
        await tab.page.locator('.toast.error').waitFor();
    });
});

describe('the page', () => {
    it('shows nothing to whoever has no token', async () => {
        const origin = new URL(studio.address).origin;
        for (const path of ['/', '/api/gallery', '/?token=wrong']) expect((await fetch(origin + path)).status).toBe(403);
    });

    it.each([[1280, 720], [3840, 2160]])('fits into %d x %d', async (width, height) => {
        const other = await studio.page({ width, height });
        await other.open('drape');
        const fits = await other.page.evaluate(() => {
            const names = ['Play', 'Refine', 'Export', 'Save'];
            const buttons = [...document.querySelectorAll('button')].filter((button) => names.includes(button.textContent ?? ''));
            return {
                count: buttons.length,
                inside: buttons.every((button) => {
                    const { left, top, right, bottom } = button.getBoundingClientRect();
                    return left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
                }),
                text: parseFloat(getComputedStyle(document.documentElement).fontSize) / innerHeight,
                scrolls: document.documentElement.scrollWidth > innerWidth,
            };
        });
        expect(fits).toMatchObject({ inside: true, scrolls: false });
        expect(fits.count).toBeGreaterThanOrEqual(4);
        expect(fits.text).toBeGreaterThan(0.012);
        await other.context.close();
    });

    it.each(['light', 'dark'] as const)('lets every control be reached by Tab, named and in sight, in %s', async (colorScheme) => {
        const other = await studio.page({ colorScheme });
        await other.open('drape');
        const { page } = other;
        await page.evaluate(() => {
            for (const section of document.querySelectorAll('details')) section.open = true;
            (document.activeElement as HTMLElement).blur();
        });
        const wrong: string[] = [];
        for (let i = 0; i < 150; ++i) {
            await other.press('Tab');
            const at = await page.evaluate(() => {
                const focused = document.activeElement as HTMLElement;
                if (focused === document.body || focused.dataset.reached) return null;
                focused.dataset.reached = 'yes';
                const { left, top, right, bottom } = focused.getBoundingClientRect();
                const seen = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
                const { outlineStyle, outlineWidth } = getComputedStyle(focused);
                const labels = [...((focused as HTMLInputElement).labels ?? [])].map((label) => label.textContent);
                return {
                    html: focused.outerHTML.slice(0, 140),
                    named: [focused.getAttribute('aria-label'), ...labels, focused.textContent].some(Boolean),
                    outlined: outlineStyle === 'solid' && parseFloat(outlineWidth) >= 2,
                    inside: left >= 0 && top >= 0 && right <= innerWidth + 0.5 && bottom <= innerHeight + 0.5,
                    uncovered: focused.classList.contains('canvas') || focused.contains(seen),
                };
            });
            if (at === null) break;
            if (!(at.named && at.outlined && at.inside && at.uncovered)) wrong.push(JSON.stringify(at));
        }
        expect(wrong).toEqual([]);
        const missed = await page.evaluate(() =>
            [...document.querySelectorAll<HTMLButtonElement>('button, input, select, summary, [tabindex]')]
                .filter((control) => !control.disabled && control.checkVisibility() && !control.dataset.reached && !control.closest('[inert]'))
                .map((control) => control.outerHTML.slice(0, 140)));
        expect(missed).toEqual([]);
        await other.context.close();
    });

    it('turns the view by keys', async () => {
        const other = await studio.page();
        await other.open('drape');
        const place = async (): Promise<number> => (await other.seen([0.2, 0, 0])).x;
        const before = await place();
        await other.page.locator('.canvas').focus();
        for (let i = 0; i < 4; ++i) await other.press('ArrowLeft');
        await expect.poll(async () => Math.abs((await place()) - before)).toBeGreaterThan(10);
        await other.context.close();
    });

    it('names its keys', async () => {
        await tab.press('Escape');
        await tab.press('?');
        await tab.page.locator('dialog.help[open]').waitFor();
        await tab.press('Escape');
        expect(await tab.page.locator('dialog.help[open]').count()).toBe(0);
    });

    it('has complained of nothing', () => {
        // A 422 and a torn connection are part of what is tested; the browser notes both.
        const own = tab.complaints.filter((text) => !/status of 422|WebSocket/.test(text));
        expect(own).toEqual([]);
    });
});
