// Starts a studio and a browser. The studio is the command in PLISSE_STUDIO_COMMAND, which prints its address; without it
// the fake server, for which some of what is tested does not exist.

import type { ChildProcess } from 'node:child_process';
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, BrowserContext, Page } from 'playwright-core';
import { chromium } from 'playwright-core';

export const isFake = !process.env.PLISSE_STUDIO_COMMAND;
/** The program itself, for checking what the studio has written. */
export const program = process.env.PLISSE_PROGRAM;
/** Times are only held against their bounds where nothing else runs. */
export const holdsTimes = process.env.PLISSE_STUDIO_TIMES === '1';

const fake = ['node', 'node_modules/vite-node/vite-node.mjs', 'dev/fake_server.ts', '0'];
const graphics = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--no-sandbox'];

export class Studio {
    readonly folder = mkdtempSync(join(tmpdir(), 'plisse-studio-'));
    address = '';
    said = '';
    private server: ChildProcess | null = null;
    private browser: Browser | null = null;

    async start(): Promise<void> {
        const [command, ...given] = isFake ? fake : process.env.PLISSE_STUDIO_COMMAND!.split(' ');
        this.server = spawn(command!, given, {
            stdio: ['ignore', 'pipe', 'pipe'],
            cwd: isFake ? process.cwd() : this.folder,
        });
        this.address = await new Promise<string>((resolve, reject) => {
            const listen = (chunk: Buffer): void => {
                this.said += String(chunk);
                const found = /http:\/\/127\.0\.0\.1:\d+\/\?token=[\w-]+/.exec(this.said);
                if (found) resolve(found[0]);
            };
            this.server!.stdout!.on('data', listen);
            this.server!.stderr!.on('data', listen);
            this.server!.on('exit', () => reject(new Error(`the server ended: ${this.said}`)));
        });
        this.browser = await chromium.launch({
            executablePath: process.env.PLISSE_CHROMIUM ?? '/usr/bin/chromium', args: graphics,
        });
    }

    async stop(): Promise<void> {
        await this.browser?.close();
        this.server?.kill();
        rmSync(this.folder, { recursive: true, force: true });
    }

    get isServerAlive(): boolean {
        return this.server?.exitCode === null && this.server.signalCode === null;
    }

    async page(options: { width?: number; height?: number; colorScheme?: 'light' | 'dark' } = {}): Promise<StudioPage> {
        const { width = 1280, height = 720, colorScheme = 'light' } = options;
        const context = await this.browser!.newContext({ viewport: { width, height }, colorScheme, acceptDownloads: true });
        context.setDefaultTimeout(Number(process.env.PLISSE_STUDIO_TIMEOUT ?? 60) * 900);
        const page = new StudioPage(context, await context.newPage());
        await page.go(this.address);
        return page;
    }

    /** What `plisse check --json` says of a file. */
    check(file: string): Record<string, unknown> {
        return JSON.parse(execFileSync(program!, ['check', '--json', file], { encoding: 'utf8' })) as Record<string, unknown>;
    }
}

interface Seen {
    x: number;
    y: number;
    distance: number;
}

/** The gizmo's arms are this long, as a share of its distance from the eye. */
const armLength = 0.08;

interface Hook {
    plisse: { positions(): number[]; state(): Record<string, unknown>; seenAt(place: number[]): Seen };
}

export class StudioPage {
    readonly complaints: string[] = [];

    constructor(
        readonly context: BrowserContext,
        readonly page: Page,
    ) {
        page.on('pageerror', (error) => this.complaints.push(error.message));
        page.on('console', (message) => {
            if (message.type() === 'error') this.complaints.push(message.text());
        });
    }

    async go(address: string): Promise<void> {
        await this.page.addInitScript(() => {
            const sockets: WebSocket[] = [];
            const Native = window.WebSocket;
            window.WebSocket = class extends Native {
                constructor(url: string | URL) {
                    super(url);
                    sockets.push(this);
                }
            };
            Object.assign(window, { sockets });
        });
        await this.page.goto(address);
        await this.page.waitForFunction(() => 'plisse' in window && document.querySelector('.topbar') !== null);
    }

    async open(scene: string): Promise<void> {
        const scenes = this.page.getByRole('button', { name: 'Open another scene' });
        const card = this.page.locator(`.card[data-gallery="${scene}"]`);
        await this.page.waitForFunction(() => (window as unknown as Hook).plisse.state().status !== null);
        await this.page.waitForFunction(() => document.querySelector<HTMLElement>('.readout')?.dataset.state !== 'building');
        if (!(await card.isVisible())) await scenes.click();
        // The scene may be the one that is open: what was there before must have been replaced.
        await this.page.evaluate(() => Object.assign(window, { before: (window as unknown as Hook).plisse.state() }));
        await card.click();
        const yes = this.page.locator('dialog[open] .primary');
        if (await yes.isVisible()) await yes.click();
        await this.page.waitForFunction(
            (id) => {
                const state = (window as unknown as Hook).plisse.state() as {
                    session?: { scene?: { name: string } }; status?: { state: string; step: number };
                };
                const { before } = window as unknown as { before: typeof state };
                if (state.session === before.session || state.status === before.status) return false;
                return state.status?.state === 'idle' && state.status.step === 0 && state.session?.scene?.name.includes(id);
            },
            scene,
        );
        await this.page.waitForFunction(() => (window as unknown as Hook).plisse.positions().length > 0);
        await this.dismissMessages();
    }

    /** So that none lies where the pointer goes next. */
    async dismissMessages(): Promise<void> {
        for (const button of await this.page.locator('.toast').getByRole('button', { name: 'Dismiss' }).all())
            await button.click({ timeout: 1000 }).catch(() => undefined);
    }

    state<T>(): Promise<T> {
        return this.page.evaluate(() => JSON.parse(JSON.stringify((window as unknown as Hook).plisse.state())) as T);
    }

    positions(): Promise<number[]> {
        return this.page.evaluate(() => (window as unknown as Hook).plisse.positions());
    }

    /** Where a place of the scene is on the screen. */
    seen(place: number[]): Promise<Seen> {
        return this.page.evaluate((at) => (window as unknown as Hook).plisse.seenAt(at), place);
    }

    /** Waits until what has been asked for is on the screen. */
    private async drawn(): Promise<void> {
        await this.page.evaluate(() => new Promise((next) => requestAnimationFrame(() => requestAnimationFrame(next))));
    }

    /** Drags an arm of the gizmo that sits at a place, by so many pixels along the arm. */
    async dragGizmo(place: number[], axis: 0 | 1 | 2, pixels: number): Promise<void> {
        // The gizmo is where it was last drawn, and what is under the pointer decides in which plane it is dragged.
        await this.drawn();
        const middle = await this.seen(place);
        const arm = await this.seen(place.map((x, k) => (k === axis ? x + armLength * 0.5 * middle.distance : x)));
        const length = Math.hypot(arm.x - middle.x, arm.y - middle.y);
        const [dx, dy] = [(arm.x - middle.x) / length, (arm.y - middle.y) / length];
        await this.page.mouse.move(arm.x, arm.y);
        await this.drawn();
        await this.page.mouse.down();
        await this.drawn();
        for (let i = 1; i <= 8; ++i) await this.page.mouse.move(arm.x + (dx * pixels * i) / 8, arm.y + (dy * pixels * i) / 8);
        await this.page.mouse.up();
    }

    async readout(name: 'level' | 'volume' | 'steps' | 'change' | 'state'): Promise<string> {
        return (await this.page.locator('.readout').getAttribute(`data-${name}`)) ?? '';
    }

    async waitForState(...states: string[]): Promise<void> {
        await this.page.waitForFunction(
            (wanted) => wanted.includes(document.querySelector<HTMLElement>('.readout')?.dataset.state ?? ''), states,
        );
    }

    /** Waits until the running state is at this step, or later. */
    async waitForStep(step: number): Promise<void> {
        await this.page.waitForFunction(
            (wanted) => Number(document.querySelector<HTMLElement>('.canvas')?.dataset.step ?? 0) >= wanted, step,
        );
    }

    async step(): Promise<number> {
        return Number(await this.page.locator('.canvas').getAttribute('data-step'));
    }

    /** Tears the connection, as a lost network does. */
    async loseConnection(): Promise<void> {
        await this.page.evaluate(() => (window as unknown as { sockets: WebSocket[] }).sockets.at(-1)!.close());
    }

    press(key: string): Promise<void> {
        return this.page.keyboard.press(key);
    }
}
