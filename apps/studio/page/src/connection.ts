// The page's end of the WebSocket. A lost connection is made again, with longer and longer waits; the server then tells
// everything anew, so that nothing is lost by it.

import type { PageMessage, ServerMessage } from './protocol';
import { parseServerMessage } from './protocol';
import type { BinaryMessage } from './binary';
import { decodeBinary } from './binary';

export interface ConnectionHandlers {
    opened(): void;
    lost(): void;
    message(message: ServerMessage): void;
    binary(message: BinaryMessage): void;
}

const firstWait = 300;
const longestWait = 8000;

/** Milliseconds to wait before the n-th attempt in a row (0, 1, ...), in [half, whole] of the step by `random`. */
export function waitBefore(attempt: number, random: number): number {
    return Math.min(longestWait, firstWait * 2 ** attempt) * (0.5 + 0.5 * random);
}

export class Connection {
    private socket: WebSocket | null = null;
    private attempt = 0;
    private timer: ReturnType<typeof setTimeout> | undefined;

    constructor(
        private readonly address: string,
        private readonly handlers: ConnectionHandlers,
    ) {}

    open(): void {
        clearTimeout(this.timer);
        const socket = new WebSocket(this.address);
        socket.binaryType = 'arraybuffer';
        socket.onopen = () => {
            this.attempt = 0;
            this.handlers.opened();
        };
        socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
            if (socket === this.socket) this.take(event.data);
        };
        socket.onclose = () => {
            if (socket === this.socket) this.retry();
        };
        this.socket = socket;
    }

    /** Sends at once, or says that it cannot: what was asked of a lost connection would surprise when it is back. */
    send(message: PageMessage): boolean {
        if (this.socket?.readyState !== WebSocket.OPEN) return false;
        this.socket.send(JSON.stringify(message));
        return true;
    }

    /** Joins anew: for a page that has lost track. */
    restart(): void {
        const socket = this.socket;
        this.socket = null;
        socket?.close();
        this.retry();
    }

    private take(data: string | ArrayBuffer): void {
        if (typeof data === 'string') {
            const message = parseServerMessage(data);
            if (message) this.handlers.message(message);
            return;
        }
        try {
            this.handlers.binary(decodeBinary(data));
        } catch (error) {
            console.error('a binary message that cannot be read', error);
        }
    }

    private retry(): void {
        this.handlers.lost();
        this.timer = setTimeout(() => this.open(), waitBefore(this.attempt++, Math.random()));
    }
}
