// `npm run fake [PORT]`: serves the built page and a session of formulas, so that the page can be worked on, and tested,
// without the solver. Prints the address as `plisse studio` does.

import { randomBytes } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import type { IncomingMessage, ServerResponse } from 'node:http';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { WebSocketServer } from 'ws';

import type { PageMessage } from '../src/protocol';
import { gallery, pictures } from './fake_scenes';
import type { Page } from './fake_session';
import { FakeSession } from './fake_session';

const here = fileURLToPath(new URL('.', import.meta.url));
const dist = process.env.PLISSE_PAGE_DIST ?? join(here, '../dist');
const images = join(here, '../../../../docs/images/psq');
const port = Number(process.argv[2] ?? 8765);
const token = randomBytes(16).toString('hex');
const session = new FakeSession();

const types: Record<string, string> = {
    '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.png': 'image/png',
};
const policy =
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; connect-src 'self'; worker-src 'self' blob:";

function isAllowed(request: IncomingMessage): boolean {
    return request.headers.cookie?.includes(`plisse_token=${token}`) ?? false;
}

function json(response: ServerResponse, status: number, value: unknown): void {
    response.writeHead(status, { 'Content-Type': 'application/json' }).end(JSON.stringify(value));
}

async function file(response: ServerResponse, path: string): Promise<void> {
    try {
        const bytes = await readFile(path);
        response.writeHead(200, { 'Content-Type': types[extname(path)] ?? 'application/octet-stream' }).end(bytes);
    } catch {
        json(response, 404, { ok: false, message: 'not found' });
    }
}

async function bodyOf(request: IncomingMessage): Promise<string> {
    const chunks: Buffer[] = [];
    for await (const chunk of request) chunks.push(chunk as Buffer);
    return Buffer.concat(chunks).toString();
}

/** Any mesh opens the cloth; one that says `bad` is shown as unusable. */
async function takeMesh(request: IncomingMessage, response: ServerResponse): Promise<void> {
    const text = await bodyOf(request);
    if (!text.includes('bad')) {
        session.open('drape');
        return json(response, 200, { ok: true });
    }
    session.showUnusable();
    const findings = { usable: false, degenerate_faces: 3, intersecting_face_pairs: 17, non_manifold_edges: 0 };
    return json(response, 422, { ok: false, message: 'bad.obj has faces that intersect each other.', findings });
}

async function answer(request: IncomingMessage, response: ServerResponse): Promise<void> {
    const address = new URL(request.url ?? '/', 'http://127.0.0.1');
    response.setHeader('Content-Security-Policy', policy);
    if (address.pathname === '/' && address.searchParams.get('token') === token)
        response.setHeader('Set-Cookie', `plisse_token=${token}; HttpOnly; SameSite=Strict; Path=/`);
    else if (!isAllowed(request)) return json(response, 403, { ok: false, message: 'no token' });
    const path = address.pathname;
    if (path === '/') return file(response, join(dist, 'index.html'));
    if (path === '/api/gallery') return json(response, 200, gallery);
    if (path.startsWith('/api/gallery/')) {
        const id = path.slice('/api/gallery/'.length, -'.png'.length);
        return file(response, join(images, normalize(`/${pictures[id] ?? id}.png`)));
    }
    if (path === '/api/mesh' && request.method === 'POST') return takeMesh(request, response);
    if (path === '/api/files') return json(response, 200, [...session.files].map(([name, text]) => ({ name, bytes: text.length })));
    if (path.startsWith('/api/files/')) {
        const text = session.files.get(decodeURIComponent(path.slice('/api/files/'.length)));
        if (text === undefined) return json(response, 404, { ok: false, message: 'not found' });
        response.writeHead(200, { 'Content-Type': 'application/octet-stream', 'Content-Disposition': 'attachment' }).end(text);
        return;
    }
    return file(response, join(dist, normalize(path)));
}

const server = createServer((request, response) => void answer(request, response));
const sockets = new WebSocketServer({ noServer: true });
server.on('upgrade', (request, socket, head) => {
    if (!isAllowed(request)) return void socket.destroy();
    sockets.handleUpgrade(request, socket, head, (client) => {
        const page: Page = { send: (data) => client.send(data), look: { detail: false, color: 'none' }, known: new Set(), frame: null };
        client.on('message', (text) => session.receive(page, JSON.parse(String(text)) as PageMessage));
        client.on('close', () => session.pages.delete(page));
        session.join(page);
    });
});
server.listen(port, '127.0.0.1', () => {
    const address = server.address();
    const actual = typeof address === 'object' && address ? address.port : port;
    console.log(`http://127.0.0.1:${actual}/?token=${token}`);
});
