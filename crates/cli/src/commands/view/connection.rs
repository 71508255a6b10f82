//! What a request must be like to be answered: from the page that the program itself serves, on this computer.

use tiny_http::Request;

/// Where the page is: on 127.0.0.1, at a port and below a word that nobody can guess.
#[derive(Clone, Debug)]
pub(super) struct Address {
    port: u16,
    token: String,
}

impl Address {
    /// # Errors
    /// The system has no randomness.
    pub(super) fn new(port: u16) -> anyhow::Result<Self> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)
            .map_err(|error| anyhow::anyhow!("there are no random numbers: {error}"))?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { port, token })
    }

    /// The address of the page.
    pub(super) fn page(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// What a request asks for below the page's address; `None` for requests of others: another site's page, or a name that was made to
    /// lead to this computer.
    pub(super) fn asked<'r>(&self, request: &'r Request) -> Option<&'r str> {
        let header = |name: &'static str| {
            let all = request.headers().iter();
            all.filter(move |own| own.field.equiv(name))
                .map(|own| own.value.as_str())
        };
        let host = format!("127.0.0.1:{}", self.port);
        let origin = format!("http://{host}");
        let is_own = header("Host").eq([host.as_str()])
            && header("Origin").all(|own| own == origin)
            && header("Sec-Fetch-Site").all(|own| matches!(own, "same-origin" | "none"));
        if !is_own {
            return None;
        }
        request
            .url()
            .strip_prefix('/')?
            .strip_prefix(self.token.as_str())?
            .strip_prefix('/')
    }
}
