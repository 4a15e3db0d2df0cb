using System;
using System.Globalization;
using System.Security.Cryptography;
using System.Text;

namespace KinefabUnity
{
    /// <summary>What something holds, as digits that are the same on every machine.</summary>
    internal static class Digest
    {
        /// <summary>MD5, hexadecimal.</summary>
        internal static string Of(ReadOnlyMemory<byte> data)
        {
            using (MD5 md5 = MD5.Create())
            {
                var digits = new StringBuilder();
                foreach (byte one in md5.ComputeHash(data.ToArray()))
                {
                    digits.Append(one.ToString("x2", CultureInfo.InvariantCulture));
                }

                return digits.ToString();
            }
        }

        /// <summary>Of a text in UTF-8.</summary>
        internal static string Of(string text) => Of(Encoding.UTF8.GetBytes(text));
    }
}
