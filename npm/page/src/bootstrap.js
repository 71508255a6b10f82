// Unpacks the page's code and runs it. Plain old script: it also runs where the rest cannot, and says so.
(async () => {
  const failed = (why) => {
    const message = document.getElementById('message');
    message.textContent = `The page could not start: ${why}`;
    message.hidden = false;
  };
  addEventListener('error', (event) => failed(event.message));
  addEventListener('unhandledrejection', (event) => failed(event.reason?.message ?? event.reason));
  if (typeof DecompressionStream === 'undefined') {
    return failed('this browser is older than 2023.');
  }
  const text = document.getElementById('code').textContent;
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  const script = document.createElement('script');
  script.textContent = await new Response(unpacked).text();
  document.body.append(script);
})();
