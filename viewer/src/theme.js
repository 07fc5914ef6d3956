// Light or dark: as the system has it, until the button says otherwise.
const kKey = 'isoweave-theme';
const system = matchMedia('(prefers-color-scheme: dark)');

// Pages from files may have no storage.
function stored() {
  try {
    return localStorage.getItem(kKey);
  } catch {
    return null;
  }
}

function store(theme) {
  try {
    localStorage.setItem(kKey, theme);
  } catch {
    // The choice holds for this page.
  }
}

export const isDark = () => document.documentElement.dataset.theme === 'dark';

export function startTheme(changed) {
  const button = document.getElementById('theme');
  const set = (theme) => {
    document.documentElement.dataset.theme = theme;
    button.setAttribute('aria-pressed', String(theme === 'dark'));
    changed();
  };
  const follow = () => set(stored() ?? (system.matches ? 'dark' : 'light'));
  button.addEventListener('click', () => {
    const theme = isDark() ? 'light' : 'dark';
    store(theme);
    set(theme);
  });
  system.addEventListener('change', follow);
  follow();
}
