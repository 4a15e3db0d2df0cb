using System;
using System.IO;
using System.Text;

namespace Kinefab.Cli;

/// <summary>
/// All that people read goes through here: what could steer a terminal is written as \uXXXX, lines' ends apart, also where a file's
/// name or an argument is printed. Notes whether anything could not be written.
/// </summary>
internal sealed class Terminal(TextWriter target) : TextWriter
{
    /// <summary>What kept text from being written; null: nothing.</summary>
    internal Exception? Fault { get; private set; }

    /// <inheritdoc/>
    public override Encoding Encoding => target.Encoding;

    /// <inheritdoc/>
    public override void Write(char value) => Write(value.ToString());

    /// <inheritdoc/>
    public override void Write(char[] buffer, int index, int count) => Write(new string(buffer, index, count));

    /// <inheritdoc/>
    public override void Write(string? value) => Raw(Printable.Lines(value ?? ""));

    /// <inheritdoc/>
    public override void WriteLine(string? value) => Raw(Printable.Lines(value ?? "") + target.NewLine);

    /// <inheritdoc/>
    public override void WriteLine() => Raw(target.NewLine);

    /// <summary>Text that is escaped already, such as JSON.</summary>
    internal void Raw(string text)
    {
        if (Fault is not null)
            return;
        try
        {
            target.Write(text);
            target.Flush();
        }
        catch (IOException fault)
        {
            Fault = fault;
        }
        catch (UnauthorizedAccessException fault)
        {
            // A descriptor that is closed, or open for reading alone.
            Fault = fault.InnerException ?? fault;
        }
    }

    /// <inheritdoc/>
    public override void Flush()
    {
        // Every write is flushed by itself.
    }
}
