using System;
using System.Collections;
using System.Reflection;
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
}
