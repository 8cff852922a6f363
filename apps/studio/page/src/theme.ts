// Light or dark: as the system says, until the user says otherwise.

const key = 'plisse-theme';
const system = matchMedia('(prefers-color-scheme: dark)');
const listeners = new Set<(isDark: boolean) => void>();

export function isDark(): boolean {
    return document.documentElement.dataset.theme === 'dark';
}

function apply(): void {
    const chosen = localStorage.getItem(key) ?? (system.matches ? 'dark' : 'light');
    document.documentElement.dataset.theme = chosen === 'dark' ? 'dark' : 'light';
    for (const listener of listeners) listener(isDark());
}

/** Sets the theme, and follows the system's while none is chosen. */
export function startTheme(): void {
    system.addEventListener('change', apply);
    apply();
}

export function toggleTheme(): void {
    localStorage.setItem(key, isDark() ? 'light' : 'dark');
    apply();
}

export function onTheme(listener: (isDark: boolean) => void): void {
    listeners.add(listener);
    listener(isDark());
}
