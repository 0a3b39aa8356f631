using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Text.RegularExpressions;
using NUnit.Framework;
using NUnit.Framework.Interfaces;
using NUnit.Framework.Internal;
using NUnit.Framework.Internal.Builders;
using NUnit.Framework.Internal.Commands;
using UnityShim;

namespace UnityEngine.TestTools
{
    /// <summary>A test that is a coroutine. Each <c>yield return null</c> waits for one frame.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    public class UnityTestAttribute : NUnitAttribute, ISimpleTestBuilder, IImplyFixture, IWrapTestMethod
    {
        public TestMethod BuildFrom(IMethodInfo method, Test? suite)
        {
            // NUnit accepts a test with a return value only if a result is expected.
            var parameters = new TestCaseParameters { ExpectedResult = null };
            return new NUnitTestCaseBuilder().BuildTestMethod(method, suite, parameters);
        }

        public TestCommand Wrap(TestCommand command) => new CoroutineCommand(command);

        private sealed class CoroutineCommand : DelegatingTestCommand
        {
            public CoroutineCommand(TestCommand inner)
                : base(inner)
            {
            }

            public override TestResult Execute(TestExecutionContext context)
            {
                try
                {
                    LogAssert.Begin();
                    Run((IEnumerator)((TestMethod)Test).Method.Invoke(context.TestObject, null)!);
                    LogAssert.End();
                    context.CurrentResult.SetResult(ResultState.Success);
                }
                catch (Exception error)
                {
                    Exception cause = error is TargetInvocationException { InnerException: { } inner } ? inner : error;
                    context.CurrentResult.RecordException(cause);
                }
                return context.CurrentResult;
            }

            private static void Run(IEnumerator coroutine)
            {
                while (coroutine.MoveNext())
                {
                    if (coroutine.Current is IEnumerator inner)
                    {
                        Run(inner);
                    }
                    else
                    {
                        World.Frame();
                    }
                }
            }
        }
    }

    /// <summary>The log messages that a test expects. As in Unity, an unexpected error fails the test.</summary>
    public static class LogAssert
    {
        private static readonly List<(LogType Type, Regex Text)> Expected = new List<(LogType, Regex)>();

        /// <summary>Whether unexpected errors are ignored in the current test.</summary>
        public static bool ignoreFailingMessages { get; set; }

        public static void Expect(LogType type, Regex message) => Expected.Add((type, message));

        internal static void Begin()
        {
            Expected.Clear();
            ignoreFailingMessages = false;
        }

        internal static void End()
        {
            var lines = Log.Lines.ToList();
            foreach ((LogType type, Regex text) in Expected)
            {
                int index = lines.FindIndex(line => line.Type == type && text.IsMatch(line.Text));
                Assert.That(index, Is.GreaterThanOrEqualTo(0), $"expected to be logged as {type}: {text}; logged was:\n" +
                    string.Join("\n", Log.Lines.Select(line => line.Type + ": " + line.Text)));
                lines.RemoveAt(index);
            }
            Assert.That(lines.Where(IsFailure).Select(line => line.Text), Is.Empty, "unexpected errors in the log");
        }

        private static bool IsFailure((LogType Type, string Text) line) => !ignoreFailingMessages &&
            (line.Type == LogType.Error || line.Type == LogType.Exception);
    }
}
