# Adaptive subdivision of meshes. packaging/finish.sh writes this with version and sum, for a tap or for homebrew-core.
class Limitmesh < Formula
  desc "Smooths triangle meshes to a tolerance, with a proven distance"
  homepage "@REPOSITORY@"
  url "@REPOSITORY@/releases/download/v@VERSION@/limitmesh-@VERSION@-source.tar.gz"
  sha256 "@SOURCE_SHA256@"
  license any_of: ["MIT", "Apache-2.0"]

  depends_on "rust" => :build

  def install
    system "cargo", "install", *std_cargo_args(path: "crates/cli")
    generate_completions_from_executable(bin/"limitmesh", "completions")
    man1.mkpath
    system bin/"limitmesh", "man", man1
  end

  test do
    system bin/"limitmesh", "refine", "builtin:cup", "-o", "cup.ply"
    assert_match "4,530 triangles", shell_output("#{bin}/limitmesh info cup.ply")
  end
end
